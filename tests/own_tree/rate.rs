//! How many rays a second: walks beside the device's own queries, in one run.

use common::glam::{DVec3, Vec3};
use common::scene::Scene;
use reference::random::Random;

use crate::rig::{Answer, BEST, By, Given, NOTHING, Rig};

/// Rays through the pixels of a picture, in blocks of 8 by 4 as workgroups have them.
fn primary(scene: &Scene, size: [u32; 2]) -> Vec<Given> {
    let camera = &scene.camera;
    let basis = camera.basis(f64::from(size[0]) / f64::from(size[1]));
    let mut given = Vec::new();
    for block in 0..size[0] / 8 * (size[1] / 4) {
        for lane in 0..32 {
            let x = block % (size[0] / 8) * 8 + lane % 8;
            let y = block / (size[0] / 8) * 4 + lane / 8;
            let u = 2.0 * (x as f32 + 0.5) / size[0] as f32 - 1.0;
            let v = 2.0 * (y as f32 + 0.5) / size[1] as f32 - 1.0;
            let direction = (basis.forward + u * basis.right - v * basis.up).normalize();
            given.push(Given { origin: basis.origin, tmax: 1e30, direction, any: 0 });
        }
    }
    given
}

/// From where rays have met something: to the light, or anywhere.
fn secondary(
    given: &[Given],
    answers: &[Answer],
    to: impl FnMut() -> Vec3,
    any: u32,
) -> Vec<Given> {
    let mut to = to;
    let mut rays = Vec::new();
    for (ray, answer) in given.iter().zip(answers) {
        if answer.instance != NOTHING {
            let origin = ray.origin + ray.direction * (answer.t * 0.9999);
            rays.push(Given { origin, tmax: 1e30, direction: to(), any });
        }
    }
    rays
}

pub fn compare(name: &str, scene: &Scene, rounds: usize) {
    let rig = Rig::beside_the_device(scene, own_tree::binned);
    let walk = rig.pipeline(By::Walk, BEST);
    let query = rig.pipeline(By::Query, BEST);
    let given = primary(scene, [960, 600]);
    let (answers, _) = rig.answers(&query, By::Query, &given);
    let light = Vec3::new(0.4, 0.3, 0.2).normalize();
    let mut random = Random(3);
    let bounce = || {
        let v: DVec3 = random.unit();
        Vec3::new(v.x as f32, v.y.abs() as f32, v.z as f32)
    };
    let kinds = [
        ("primary", given.clone()),
        ("shadow", secondary(&given, &answers, || light, 1)),
        ("bounce", secondary(&given, &answers, bounce, 0)),
    ];
    for (kind, rays) in kinds {
        let mut ratios = Vec::new();
        let mut rates = Vec::new();
        let mut differ = 0;
        let mut steps = 0.0;
        for _ in 0..rounds {
            let (ours, own) = rig.answers(&walk, By::Walk, &rays);
            let (theirs, device) = rig.answers(&query, By::Query, &rays);
            ratios.push(device / own);
            rates.push(rays.len() as f64 / own / 1e3);
            let hit = |answer: &Answer| answer.instance;
            differ = ours
                .iter()
                .zip(&theirs)
                .filter(|(a, b)| (hit(a) == NOTHING) != (hit(b) == NOTHING))
                .count();
            steps = ours.iter().map(|a| f64::from(a.count)).sum::<f64>() / rays.len() as f64;
        }
        ratios.sort_by(f64::total_cmp);
        rates.sort_by(f64::total_cmp);
        println!(
            "{name} {kind}: {:.2} times as fast ({:.2} to {:.2}); {:.2} million rays a second; {steps:.1} steps; {differ} of {} differ",
            ratios[rounds / 2],
            ratios[rounds / 4],
            ratios[3 * rounds / 4],
            rates[rounds / 2],
            rays.len()
        );
    }
}

#[test]
#[ignore = "by hand: takes times"]
fn walks_beside_queries() {
    compare("chess", &Scene::chess().expect("the chess set"), 9);
}
