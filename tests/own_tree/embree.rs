//! Our walk next to Embree, a library for processors, on the same rays.

use std::fs;
use std::process::Command;

use common::glam::Vec3;
use common::scene::Scene;
use own_tree::Builder;
use run::expected;
use serde_json::{Map, Value};

use crate::rate::{balls, kinds, landscape, median};
use crate::rig::{Answer, BEST, By, Given, NOTHING, Rig};

/// Rounds of our walk; the script takes as many of Embree's.
const ROUNDS: usize = 7;

fn vector(v: Vec3) -> impl Iterator<Item = u32> {
    v.to_array().map(f32::to_bits).into_iter()
}

/// The triangles in the world and the rays, as `embree.py` reads them.
fn file(scene: &Scene, kinds: &[(&str, Vec<Given>)]) -> Vec<u32> {
    let mut words = vec![0];
    for instance in &scene.instances {
        let mesh = &scene.model.meshes[instance.mesh];
        for corner in mesh.triangles.iter().flatten() {
            let position = mesh.vertices[*corner as usize].position;
            words.extend(vector(instance.transform.transform_point3(position)));
        }
    }
    words[0] = (words.len() / 9) as u32;
    for (_, rays) in kinds {
        words.extend([rays.len() as u32, rays[0].any]);
        words.extend(rays.iter().flat_map(|ray| vector(ray.origin).chain(vector(ray.direction))));
    }
    words
}

#[test]
#[ignore = "by hand: takes times; needs `pip install embreex numpy`"]
fn walks_beside_embree() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut figures = Map::new();
    let scenes = [
        ("chess", Scene::chess().expect("the chess set")),
        ("landscape", landscape(708)),
        ("balls", balls()),
    ];
    for (name, scene) in scenes {
        let rig = Rig::beside_the_device(&scene, Builder::Reinserted);
        let kinds = kinds(&rig, &scene);
        let path = folder.path().join(name);
        fs::write(&path, bytemuck::cast_slice(&file(&scene, &kinds))).expect("it can be written");
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/own_tree/embree.py");
        let output = Command::new("python3").arg(script).arg(&path).output().expect("python3");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let theirs: Vec<Value> = serde_json::from_slice(&output.stdout).expect("a list");
        let walk = rig.way(By::Walk, BEST);
        for ((kind, rays), theirs) in kinds.iter().zip(theirs) {
            let mut hits = 0;
            let mut round = |_| {
                let (answers, milliseconds) = rig.answers(&walk, rays);
                hits = answers.iter().filter(|answer: &&Answer| answer.instance != NOTHING).count();
                milliseconds
            };
            let own = median((0..ROUNDS).map(&mut round).collect());
            let ms = theirs["ms"].as_f64().expect("a time");
            println!(
                "{name} {kind}: Embree is {:.2} times as fast; {hits} of {} hit, Embree {}",
                own / ms,
                rays.len(),
                theirs["hits"]
            );
            figures.insert(format!("{name}.{kind}.ratio"), (own / ms).into());
            figures.insert(format!("{name}.{kind}.rate"), (1e3 * rays.len() as f64 / ms).into());
        }
    }
    expected::give_timed("30_own_tree/embree", figures.into());
}
