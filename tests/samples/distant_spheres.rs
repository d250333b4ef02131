//! 42_distant_spheres: the benefit of each rung and of the margin, compared with exact arithmetic.

mod errors;
mod plots;
mod rungs;

use common::gpu::ShaderEnum;
use common::scene::Camera;
use reference::Ray;

use crate::intersection::{Bound, Hits, ReferenceShapes, random, shapes};
use run::Chapter;

#[allow(dead_code)]
#[path = "../../samples/42_distant_spheres/scenes.rs"]
mod scenes;

use errors::Errors;
use scenes::SceneKind;

const NAME: &str = "42_distant_spheres";
const SIZE: &str = "120x75";
/// The relative error of one rounding to f32.
const U: f64 = 1.0 / 16_777_216.0;

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The shapes of a scene.
fn reference(scene: SceneKind, count: u32) -> ReferenceShapes {
    ReferenceShapes::new(|model, pieces| scenes::shapes(scene, count, model, pieces))
}

/// Compares every seventh ray of a scene of many shapes with the exact nearest hit.
fn every_hit_agrees(scene: SceneKind, count: u32, sets: &[&str]) {
    let exact = reference(scene, count);
    let camera = scenes::camera(scene, Camera::default(), count, 0.0);
    let name = format!("scene={}", SceneKind::LAYOUT.words[scene as usize]);
    let sets = [&[name.as_str()], sets].concat();
    let [hits, directions] =
        ["hit", "ray direction"].map(|show| chapter(SIZE).sets(&sets).set("show", show).picture());
    let bound = |ray: &Ray, _| {
        let far = ray.origin.length() + 25.0;
        Bound { along: 8.0 * U * far, across: 8.0 * U * far }
    };
    let found = Hits::compare(&exact, &camera, [&hits, &directions], bound);
    let (mut spheres, mut boxes) = (Errors::default(), Errors::default());
    for (_, id, t, exact_t) in &found.same {
        let of_kind = if id.0 == exact.first { &mut spheres } else { &mut boxes };
        of_kind.add(Some(*t), Some(*exact_t));
    }
    for (kind, errors) in [("spheres", &spheres), ("boxes", &boxes)] {
        if errors.rays > 0 {
            println!("{sets:?}, {kind}: {} hits, {}", errors.ulp.len(), errors.row());
            assert!(errors.at(0.99) <= 4.0, "{kind}: {}", errors.row());
        }
    }
    assert!(spheres.ulp.len() > 150, "{}", spheres.row());
    assert!(found.outlines + found.ties < 10, "{} {}", found.outlines, found.ties);
}

#[test]
fn every_hit_of_many_spheres_is_the_reference_s() {
    every_hit_agrees(SceneKind::Grid, 10_000, &[]);
    for rung in ["projection", "stable"] {
        every_hit_agrees(SceneKind::RandomBall, 1024, &[&format!("sphere rung={rung}")]);
    }
}

/// A grain may be smaller than the rounding of its hit.
#[test]
fn dust_has_a_normal_everywhere() {
    for show in ["picture", "normal", "shadow origin"] {
        let show = format!("show={show}");
        let picture = chapter(SIZE).sets(&["scene=dust", &show]).picture();
        assert!(picture.pixels.iter().flatten().all(|value| value.is_finite()), "{show}");
    }
}
