//! Pieces on the ground: the visible surfaces, and their shadows.

use std::collections::{BTreeMap, BTreeSet};

use common::scene::Sun;
use glam::{DVec3, Vec3};
use reference::Ray;

use super::judged::Verdict;
use super::marched::camera;
use super::world::World;
use super::{GROUND, HILLS, STEEP, chapter, land, scenes};
use run::primary_hits::rays;

/// A cube of a millimetre far away, one of a kilometre, and one the size of the chess set.
#[test]
fn a_model_from_a_file_stands_on_the_hill_whatever_its_size() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cube.obj");
    let seen = |size: f64, at: f64| {
        let corner = |i: usize| [1, 2, 4].map(|bit| at + if i & bit == 0 { 0.0 } else { size });
        let corners = (0..8).map(corner).map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
        std::fs::write(&file, corners.collect::<String>() + faces).unwrap();
        let scene = ["--scene", file.to_str().expect("a path of text")];
        let hits = chapter("120x75").sets(&["show=hit"]).with(&scene).picture();
        hits.pixels.iter().filter(|pixel| pixel[0] == 0.0).count()
    };
    let counts = [seen(1e-3, 0.2), seen(1e3, -1e5), seen(2.0, 0.0)];
    println!("{counts:?} pixels");
    assert!(
        counts.iter().all(|&count| count > 200 && count.abs_diff(counts[2]) < 10),
        "{counts:?}"
    );
}

#[test]
fn the_chess_set_stands_on_the_ground() {
    let scene = scenes::chess().unwrap();
    for landscape in [HILLS, STEEP] {
        let (mut feet, mut highest) = (0, 0.0f32);
        for piece in &scene.instances {
            let mesh = &scene.model.meshes[piece.mesh];
            let Some(placed) = land::stand(landscape, piece, mesh) else {
                continue;
            };
            // Upright, above its former place.
            let by = placed.transform.translation - piece.transform.translation;
            assert!(
                placed.transform.matrix3 == piece.transform.matrix3 && by.x == 0.0 && by.z == 0.0
            );
            let bottom = mesh.bounds().0.y;
            let foot = mesh.vertices.iter().map(|vertex| vertex.position);
            let gaps = foot.filter(|position| position.y == bottom).map(|position| {
                let at = placed.transform.transform_point3(position);
                f64::from(at.y) - landscape.height(at.x, at.z)
            });
            let (least, most) =
                gaps.fold((f64::MAX, f64::MIN), |(a, b), gap| (a.min(gap), b.max(gap)));
            // It touches the ground, and no part of the foot is in the air.
            assert!(most.abs() < 1e-5 && least > -0.6, "{least} {most}");
            highest = highest.max(placed.transform.translation.y);
            feet += 1;
        }
        println!("k = {}: {feet} pieces stand, the highest at {highest}", landscape.k);
        assert!(if landscape == HILLS { feet == 28 } else { feet < 28 && feet > 0 });
        // The device uses the same transforms.
        let k = format!("steepness={}", landscape.k);
        let sets = [&k[..], "camera eye=8,70,1", "camera target=8,0,0"];
        let sets = [&sets[..], &["field of view=8", "show=hit"]].concat();
        let seen = chapter("300x300").sets(&sets).picture();
        let seen: BTreeSet<i32> = seen.pixels.iter().map(|hit| hit[0] as i32).collect();
        assert_eq!(
            seen.iter().filter(|instance| (0..GROUND as i32).contains(*instance)).count(),
            feet
        );
    }
}

#[test]
fn ground_and_pieces_hide_each_other() {
    let world = World::new();
    let mut seen = BTreeMap::<String, usize>::new();
    let (mut edges, mut all) = (0, 0);
    for preset in ["preset=hills", "preset=from above", "preset=near ground"] {
        let show = |view| chapter("120x75").sets(&[preset, view]).picture();
        let (directions, hits) = (show("show=ray direction"), show("show=hit"));
        for (ray, hit) in rays(&camera(&[preset]), &directions).zip(&hits.pixels) {
            all += 1;
            let (expected, t) = world.first(&ray);
            if expected != hit[0] {
                assert!(world.is_close(&ray), "{ray:?} {hit:?} {expected} {t}");
                edges += 1;
                continue;
            }
            if expected == GROUND {
                let exact = world.ground.hit(&ray);
                let verdict = world.ground.judge(&ray, Some(hit[2].into()), exact.as_ref());
                assert!(verdict == Verdict::Right, "{ray:?} {hit:?} {verdict:?}");
            }
            *seen.entry(format!("{preset} {}", kind(expected))).or_default() += 1;
        }
    }
    println!("{seen:?}, {edges} of {all} rays at edges");
    // From above there is no sky.
    assert!(seen.len() == 8 && seen.values().all(|count| *count > 50), "{seen:?}");
    assert!(edges * 200 < all, "{edges}");
}

#[test]
fn shadows_fall_both_ways_and_no_ground_shades_itself() {
    let world = World::new();
    // The number of pixels for each pair of shadowed surface and occluder.
    let mut seen = BTreeMap::<String, usize>::new();
    let (mut edges, mut facing_away, mut from_ground) = (0, 0, 0);
    let sun = |azimuth, elevation| Sun { azimuth, elevation, ..Sun::default() }.light().direction;
    // The second sun is so low that hills shade hills; the third view is inside the pond; the last sun is
    // over the pieces.
    for (to_light, sets) in [
        (sun(270.0, 17.0), &["sun azimuth=270", "sun elevation=17"][..]),
        (sun(240.0, 10.0), &["sun azimuth=240", "sun elevation=10"]),
        (sun(270.0, 17.0), &["camera eye=-8,0.25,6", "camera target=-8,-0.75,-2"]),
        (sun(20.0, 75.0), &["sun azimuth=20", "sun elevation=75"]),
    ] {
        let show = |view| chapter("150x94").sets(sets).sets(&[view]).picture();
        let (hits, shadows) = (show("show=hit"), show("show=shadow origin"));
        for (hit, &[x, y, z, visible]) in hits.pixels.iter().zip(&shadows.pixels) {
            let on = kind(hit[0]);
            if on == "sky" {
                continue;
            }
            let start = Vec3::new(x, y, z);
            let ray = Ray::from_f32(start.to_array(), to_light.to_array(), 0.0, 1e30);
            if on == "ground" {
                // The start is higher above the ground than the error of the height.
                let height = world.ground.height_above(&ray, 0.0);
                assert!(height > world.ground.error, "{ray:?} {height}");
                from_ground += 1;
            }
            let ground = world.ground.field.height(x.into(), z.into()).1;
            let faces = match on {
                "ground" => DVec3::new(-ground[0], 1.0, -ground[1]).dot(ray.direction) > 1e-6,
                // The orientation of its triangle is unknown here; a lit one faces the sun.
                _ => visible > 0.0 || world.first(&ray).0 != -1.0,
            };
            if !faces {
                // A surface that faces away from the sun needs no ray.
                assert!(visible == 0.0);
                facing_away += 1;
                continue;
            }
            let by = kind(world.first(&ray).0);
            if (by == "sky") != (visible > 0.0) {
                assert!(world.is_close(&ray), "{on} {by} {ray:?}");
                edges += 1;
                continue;
            }
            *seen.entry(format!("{on} by {by}")).or_default() += 1;
        }
    }
    println!("{seen:?}, {from_ground} on the ground, {facing_away} face away, {edges} at edges");
    for kind in
        ["ground by sky", "ground by ground", "ground by piece", "piece by sky", "piece by piece"]
    {
        assert!(seen.get(kind).is_some_and(|count| *count > 20), "{kind}: {seen:?}");
    }
    assert!(edges < 20 && from_ground > 3000, "{edges} {from_ground}");
}

/// The name of an instance of `show=hit`.
fn kind(instance: f32) -> &'static str {
    match instance {
        GROUND => "ground",
        -1.0 => "sky",
        _ => "piece",
    }
}
