//! Scenes against a plain loop over all their triangles.

use super::super::random::{Random, sheet, towards};
use super::super::triangle;
use super::*;
use std::time::Instant;

fn scene() -> Scene {
    let rows = [
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.0]],
        [[-1.5, 0.2, 0.0, 0.3], [0.1, 1.0, 0.3, 0.5], [0.0, -0.4, 2.0, 0.0]],
    ];
    Scene::new(rows.map(|rows| Instance {
        transform: Transform::from_rows(rows).unwrap(),
        triangles: sheet(8, 0.3),
    }))
}

#[test]
fn finds_what_testing_every_triangle_finds() {
    let scene = scene();
    let mut random = Random(30);
    let mut several = 0;
    for _ in 0..2000 {
        let ray = towards(random.in_cube() * 3.0, random.in_cube());
        let hits = scene.all_hits(&ray);
        let mut expected: Vec<_> = (scene.items.iter())
            .filter_map(|item| Some((triangle::intersect(&ray, &item.triangle)?.t, item)))
            .map(|(t, item)| (t, item.instance, item.primitive))
            .collect();
        expected.sort_by(|p, q| p.partial_cmp(q).unwrap());
        let found: Vec<_> = hits.iter().map(|h| (h.t, h.instance, h.primitive)).collect();
        assert_eq!(found, expected);
        assert_eq!(scene.closest_hit(&ray, |_| true), hits.first().copied());
        let second = |hit: &Hit| hit.instance == 1;
        let expected = hits.iter().find(|hit| second(hit)).copied();
        assert_eq!(scene.closest_hit(&ray, second), expected);
        several += usize::from(hits.len() > 1);
        for hit in hits {
            let [a, b, c] = scene.triangle(hit.instance, hit.primitive).unwrap();
            let [v, w] = hit.barycentrics.to_array();
            let point = a * (1.0 - v - w) + b * v + c * w;
            assert!((point - ray.at(hit.t)).length() < 1e-12);
        }
    }
    assert!(several > 500, "{several}");
}

#[test]
fn candidates_are_the_hits_and_what_is_within_the_bound() {
    let scene = scene();
    let mut random = Random(31);
    let mut near_misses = 0;
    for _ in 0..2000 {
        let item = &scene.items[random.below(scene.items.len())];
        let target = item.triangle[0].lerp(item.triangle[1], random.between(0.0, 1.0));
        let ray = towards(target + random.unit() * 3.0, target);
        let candidates = scene.near_candidates(&ray);
        for hit in scene.all_hits(&ray) {
            assert!(candidates.iter().any(|candidate| candidate.hit == hit));
        }
        for item in &scene.items {
            let (instance, primitive) = (item.instance, item.primitive);
            let candidate = scene.candidate_at(&ray, instance, primitive).unwrap();
            assert_eq!(candidates.contains(&candidate), candidate.may_hit(&ray));
        }
        near_misses += candidates.iter().filter(|near| !near.hit.crossing.inside).count();
        assert!(candidates.iter().any(|near| near.graze.may_miss()));
    }
    assert!(near_misses > 500, "{near_misses}");
}

#[test]
fn candidates_may_lie_beside_their_boxes() {
    let triangles = vec![[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
    let scene = Scene::new([Instance { transform: Transform::identity(), triangles }]);
    let count = |y: f64| {
        let ray = towards(DVec3::new(0.5, y, 4.0), DVec3::new(0.5, y, 0.0));
        assert!(scene.all_hits(&ray).is_empty());
        scene.near_candidates(&ray).len()
    };
    assert_eq!((count(-1e-6), count(-1e-5)), (1, 0));
}

#[test]
fn facing_is_that_of_the_object() {
    let triangles = vec![[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
    for mirror in [1.0, -1.0] {
        let rows = [[mirror, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let transform = Transform::from_rows(rows).unwrap();
        let scene = Scene::new([Instance { transform, triangles: triangles.clone() }]);
        let target = DVec3::new(0.25 * f64::from(mirror), 0.25, 0.0);
        let facing = |z: f64| {
            let ray = towards(target + DVec3::Z * z, target);
            scene.closest_hit(&ray, |_| true).unwrap().counterclockwise
        };
        assert!(facing(5.0) && !facing(-5.0), "{mirror}");
    }
}

#[test]
fn empty_scenes_and_unknown_triangles() {
    let ray = towards(DVec3::Z, DVec3::ZERO);
    let empty = Scene::new([]);
    assert!(empty.is_empty() && empty.closest_hit(&ray, |_| true).is_none());
    assert!(empty.near_candidates(&ray).is_empty());
    let scene = scene();
    assert_eq!(scene.len(), 256);
    assert!(scene.triangle(1, 127).is_some() && scene.triangle(1, 128).is_none());
    assert!(scene.triangle(2, 0).is_none() && scene.triangle(u32::MAX, 0).is_none());
}

/// 100,000 rays into 100,000 triangles; the time is printed, not asserted.
#[test]
fn a_large_scene_is_a_matter_of_seconds() {
    let start = Instant::now();
    let transform = Transform::identity();
    let scene = Scene::new([Instance { transform, triangles: sheet(224, 0.2) }]);
    let built = start.elapsed();
    let mut random = Random(32);
    let mut hits = 0;
    for _ in 0..100_000 {
        let target = random.in_cube() * DVec3::new(0.99, 0.0, 0.99);
        let origin = DVec3::new(0.0, 2.0, 3.0);
        hits += usize::from(scene.closest_hit(&towards(origin, target), |_| true).is_some());
    }
    println!("{} triangles built in {built:?}, all in {:?}", scene.len(), start.elapsed());
    assert_eq!(scene.len(), 100_352);
    // The border of the sheet is crumpled too, so that some rays pass below it.
    assert!(hits > 95_000, "{hits}");
}
