//! Rays per second: walks and the device's own queries, in one run.

use std::cell::LazyCell;

use common::glam::{Affine3A, DVec3, Quat, Vec3};
use common::scene::{Camera, Instance, Scene};
use own_tree::Builder;
use reference::Ray;
use reference::random::Random;
use run::expected;
use run::primary_hits::reference;
use serde_json::{Map, Value, json};

use crate::hunts;
use crate::rig::{
    Answer, BARE, BEST, By, Given, MOELLER, NOTHING, PACKED, Rig, Rungs, SINGLE, TWO_FLOAT,
    WATERTIGHT,
};

/// Rays through the pixels of a picture, in blocks of 8 by 4, like a workgroup.
pub fn primary(scene: &Scene, size: [u32; 2]) -> Vec<Given> {
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

/// Rays that start at the hits of others, each in the direction that `to` returns for its hit.
fn secondary(
    given: &[Given],
    answers: &[Answer],
    mut to: impl FnMut(&Given, &Answer) -> Vec3,
    any: u32,
) -> Vec<Given> {
    let hits = given.iter().zip(answers).filter(|(_, answer)| !misses(answer));
    let ray = |(ray, answer): (&Given, &Answer)| Given {
        origin: ray.origin + ray.direction * (answer.t * 0.9999),
        tmax: 1e30,
        direction: to(ray, answer),
        any,
    };
    hits.map(ray).collect()
}

/// The unit normal of the triangle that a walk has hit, on the ray's side.
fn normal_at(rig: &Rig, scene: &Scene, ray: &Given, answer: &Answer) -> Vec3 {
    let instance = &scene.instances[answer.instance as usize];
    let orders = &rig.own.trees.orders;
    let first: usize = orders[..instance.mesh].iter().map(Vec::len).sum();
    let triangle = orders[instance.mesh][answer.position as usize - first];
    let mesh = &scene.model.meshes[instance.mesh];
    let corners = mesh.triangles[triangle as usize];
    let [a, b, c] = corners.map(|at| {
        instance.transform.transform_point3(mesh.vertices[at as usize].position).as_dvec3()
    });
    let normal = (b - a).cross(c - a).normalize().as_vec3();
    if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
}

/// The kinds of rays in a scene: through pixels, from the hits to the light, and from the hits in random
/// directions away from the surface.
pub fn kinds(rig: &Rig, scene: &Scene) -> [(&'static str, Vec<Given>); 3] {
    let given = primary(scene, [960, 600]);
    let (answers, _) = rig.answers(&rig.way(By::Walk, BEST), &given);
    let light = Vec3::new(0.4, 0.3, 0.2).normalize();
    let mut random = Random(3);
    let away = |ray: &Given, answer: &Answer| {
        let v: DVec3 = random.unit();
        let (v, normal) = (v.as_vec3(), normal_at(rig, scene, ray, answer));
        if v.dot(normal) < 0.0 { -v } else { v }
    };
    let shadow = secondary(&given, &answers, |_, _| light, 1);
    let bounce = secondary(&given, &answers, away, 0);
    [("primary", given), ("shadow", shadow), ("bounce", bounce)]
}

/// The median of some numbers, and their quartiles.
fn quartiles(mut numbers: Vec<f64>) -> [f64; 3] {
    numbers.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| numbers[quarter * (numbers.len() - 1) / 4])
}

/// The median of some numbers.
pub fn median(numbers: Vec<f64>) -> f64 {
    quartiles(numbers)[1]
}

fn misses(answer: &Answer) -> bool {
    answer.instance == NOTHING
}

/// The speed of walks relative to the device's own, for each kind of ray.
fn compare(name: &str, scene: &Scene, figures: &mut Map<String, Value>) {
    const ROUNDS: usize = 9;
    let rig = Rig::beside_the_device(scene, Builder::Reinserted);
    let (walk, device) = (rig.way(By::Walk, BEST), rig.way(By::Device, BEST));
    let single = rig.way(By::Walk, SINGLE);
    let exact = LazyCell::new(|| reference(scene));
    for (kind, rays) in kinds(&rig, scene) {
        let (mut ratios, mut rates, mut steps) = (Vec::new(), Vec::new(), 0.0);
        let mut words = Vec::new();
        let mut near = 0;
        let mut differing: Vec<(&Given, Answer)> = Vec::new();
        for _ in 0..ROUNDS {
            let (ours, own) = rig.answers(&walk, &rays);
            let (theirs, its) = rig.answers(&device, &rays);
            ratios.push(its / own);
            words.push(rig.answers(&single, &rays).1 / own);
            rates.push(rays.len() as f64 / own * 1e-3);
            let both = rays.iter().zip(&ours).zip(&theirs);
            let differ = both.filter(|((_, ours), theirs)| misses(ours) != misses(theirs));
            differing = differ.map(|((ray, ours), _)| (ray, *ours)).collect();
            near = ours.iter().filter(|a| !misses(a) && a.t < 0.01).count();
            steps = ours.iter().map(|a| f64::from(a.count)).sum::<f64>() / rays.len() as f64;
        }
        let ([low, ratio, high], [_, rate, _]) = (quartiles(ratios), quartiles(rates));
        let differ = differing.len();
        let is_right = |(given, ours): &&(&Given, Answer)| {
            let Given { origin, tmax, direction, .. } = **given;
            let ray = Ray::from_f32(origin.to_array(), direction.to_array(), 0.0, tmax);
            misses(ours) == exact.closest_hit(&ray, |_| true).is_none()
        };
        let words = median(words);
        let walk_right = differing.iter().filter(is_right).count();
        println!(
            "{name} {kind}: {ratio:.2} times as fast ({low:.2} to {high:.2}); {rate:.2} million rays \
             a second; {words:.2} times as fast as in 32-bit words; {steps:.1} steps; {near} hits nearer than 0.01; \
             {differ} of {} differ in hit or miss, the walk is right in {walk_right}",
            rays.len()
        );
        let timed = [("ratio", ratio), ("low", low), ("high", high), ("rate", 1e6 * rate)];
        for (what, value) in timed.into_iter().chain([("steps", steps), ("words", words)]) {
            figures.insert(format!("{name}.{kind}.{what}"), value.into());
        }
        figures.insert(format!("{name}.{kind}.differ"), differ.into());
        figures.insert(format!("{name}.{kind}.right"), walk_right.into());
        figures.insert(format!("{name}.{kind}.rays"), rays.len().into());
    }
}

/// A landscape with this many rows and columns of vertices, and two triangles for each four.
pub fn landscape(side: u32) -> Scene {
    let height =
        |x: f64, z: f64| 0.3 * (3.0 * x).sin() * (2.0 * z).cos() + 0.02 * (40.0 * x * z).sin();
    let corners = (0..side * side).map(|k| {
        let at = |k: u32| f64::from(k) / f64::from(side - 1) * 4.0 - 2.0;
        let (x, z) = (at(k % side), at(k / side));
        DVec3::new(x, height(x, z), z)
    });
    let cell = |k: u32| {
        let first = k / (side - 1) * side + k % (side - 1);
        [[first, first + side, first + 1], [first + 1, first + side, first + side + 1]]
    };
    let triangles = (0..(side - 1) * (side - 1)).flat_map(cell);
    let mut scene = hunts::scene((corners.collect(), triangles.collect()), 1.0, DVec3::ZERO);
    scene.camera = Camera::new(DVec3::new(-2.2, 1.6, 2.6), DVec3::new(0.0, -0.1, 0.0), 45.0);
    scene
}

/// Ten thousand balls sharing one mesh.
pub fn balls() -> Scene {
    let mut scene = hunts::scene(hunts::ball(2), 1.0, DVec3::ZERO);
    let mut random = Random(5);
    let ball = scene.instances[0];
    scene.instances = (0..10_000)
        .map(|_| {
            let (at, size) = (random.in_cube() * 2.0, random.between(0.01, 0.04));
            let transform = Affine3A::from_scale_rotation_translation(
                Vec3::splat(size as f32),
                Quat::IDENTITY,
                at.as_vec3(),
            );
            Instance { transform, ..ball }
        })
        .collect();
    scene.camera = Camera::new(DVec3::new(-3.0, 2.4, 4.0), DVec3::ZERO, 45.0);
    scene
}

/// Compares t, triangle and steps of the benchmark's rays between walks that read nodes in 32-bit and in 64-bit words.
fn compare_words(landscape: Scene) {
    let chess = Scene::chess().expect("the chess set");
    for (name, scene) in [("chess", chess), ("landscape", landscape), ("balls", balls())] {
        let rig = Rig::beside_the_device(&scene, Builder::Binned);
        if rig.gpu.features.core.shader_int64 == ash::vk::FALSE {
            return;
        }
        let ways = [SINGLE, BEST].map(|rungs| rig.way(By::Walk, rungs));
        for (kind, rays) in kinds(&rig, &scene) {
            let [single, double] = ways.each_ref().map(|way| rig.answers(way, &rays).0);
            let bits = |answer: &Answer| {
                let Answer { t, instance, position, count } = *answer;
                (t.to_bits(), instance, position, count)
            };
            assert!(!rays.is_empty());
            assert!(single.iter().map(bits).eq(double.iter().map(bits)), "{name}, {kind}");
        }
    }
}

#[test]
fn words_of_64_bits_change_no_answer() {
    compare_words(landscape(72));
}

#[test]
#[ignore = "nightly: builds a tree over a million triangles; quick: rate::words_of_64_bits_change_no_answer"]
fn nor_do_they_in_a_large_landscape() {
    compare_words(landscape(708));
}

/// A device without queries uses its pipeline: the same rays, and the same answers.
#[test]
fn what_is_traced_is_what_is_queried() {
    let scene = Scene::chess().expect("the chess set");
    let mut rig = Rig::beside_the_device(&scene, Builder::Binned);
    let queried = rig.way(By::Device, BEST);
    rig.queries = false;
    let traced = rig.way(By::Device, BEST);
    let nearest = primary(&scene, [96, 60]);
    let [(ours, _), (theirs, _)] = [&queried, &traced].map(|way| rig.answers(way, &nearest));
    for (one, other) in ours.iter().zip(&theirs) {
        // At an edge, another triangle may be hit at the same distance.
        let is_tie = (one.t - other.t).abs() <= 1e-5 * one.t && misses(one) == misses(other);
        assert!(is_tie, "{} and {}, of {} and {}", one.t, other.t, one.instance, other.instance);
    }
    let same = ours.iter().zip(&theirs).filter(|(a, b)| a.instance == b.instance).count();
    assert!(same + 4 >= nearest.len(), "{same} of {}", nearest.len());
    let any: Vec<_> = nearest.iter().map(|ray| Given { any: 1, ..*ray }).collect();
    let [(ours, _), (theirs, _)] = [&queried, &traced].map(|way| rig.answers(way, &any));
    assert!(ours.iter().map(misses).eq(theirs.iter().map(misses)));
    assert!(ours.iter().any(misses) && !ours.iter().all(misses));
}

#[test]
#[ignore = "by hand: takes times"]
fn walks_beside_queries() {
    let mut figures = Map::new();
    compare("chess", &Scene::chess().expect("the chess set"), &mut figures);
    compare("landscape", &landscape(708), &mut figures);
    compare("balls", &balls(), &mut figures);
    expected::give_timed("30_own_tree/rate", figures.into());
}

/// The time of each pair of tests of boxes and triangles: primary rays and bounces on the chess set.
#[test]
#[ignore = "by hand: takes times"]
fn the_time_of_each_rung() {
    const ROUNDS: usize = 7;
    let scene = Scene::chess().expect("the chess set");
    let rig = Rig::beside_the_device(&scene, Builder::Reinserted);
    let [(_, primary), _, (_, bounce)] = kinds(&rig, &scene);
    let rays = [primary, bounce].concat();
    let mut figures = Map::new();
    let best = rig.way(By::Walk, BEST);
    let triangles = [("moeller", MOELLER), ("watertight", WATERTIGHT), ("two-float", TWO_FLOAT)];
    for (name, triangles) in triangles {
        for (boxes, of_boxes) in (BARE..).zip(["bare", "guess", "ize", "bound", "two-float"]) {
            let walk = rig.way(By::Walk, Rungs { boxes, triangles, ..BEST });
            let ratio = |_| rig.answers(&walk, &rays).1 / rig.answers(&best, &rays).1;
            let [low, ratio, high] = quartiles((0..ROUNDS).map(ratio).collect());
            println!("{name} {of_boxes}: {ratio:.2} ({low:.2} to {high:.2})");
            for (what, value) in [("", ratio), (".low", low), (".high", high)] {
                figures.insert(format!("{name}.{of_boxes}{what}"), value.into());
            }
        }
    }
    let walk = rig.way(By::Walk, PACKED);
    let ratio = |_| rig.answers(&walk, &rays).1 / rig.answers(&best, &rays).1;
    let [_, ratio, _] = quartiles((0..ROUNDS).map(ratio).collect());
    figures.insert("quantised".to_owned(), ratio.into());
    println!("36 bytes: {ratio:.2}");
    expected::give_timed("30_own_tree/rungs", figures.into());
}

/// Bytes of nodes and of corners per triangle of the chess set.
#[test]
fn memory_is_what_the_page_says() {
    let scene = Scene::chess().expect("the chess set");
    let triangles: usize = scene.model.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let rig = Rig::new(&scene, Builder::Reinserted);
    let [nodes, corners, _] = rig.own.trees.bytes;
    let each = |bytes: usize| bytes as f64 / triangles as f64;
    let quantised = nodes / 64 * 36;
    expected::hold(
        "30_own_tree/memory",
        json!({ "triangles": triangles, "nodes": each(nodes), "quantised": each(quantised),
                "corners": each(corners), "stack": rig.own.trees.stack }),
    );
    assert!(each(nodes) < 64.0);
}
