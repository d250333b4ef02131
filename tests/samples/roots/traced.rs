//! Rays through the device's boxes: the nearest hit of all tori, and the shadow rays that leave them.

use common::scene::{Scene, Sun};
use glam::{DVec3, Vec3};
use reference::Ray;
use reference::torus::Torus;
use run::primary_hits::{answer, rays};
use run::{Chapter, has_worst_arithmetic};

use super::direct::{Case, Found};
use super::judged::{Exact, Tally};
use super::shapes::exact;
use super::{NAME, row};
use scenes::SceneKind;

#[allow(dead_code)]
#[path = "../../../samples/33_roots/scenes.rs"]
pub mod scenes;
#[allow(dead_code)]
#[path = "../../../samples/33_roots/tori.rs"]
pub mod tori;

/// The tori of a scene.
pub fn scene(kind: SceneKind, tube: f32) -> Vec<tori::Torus> {
    let mut model = Scene::chess().expect("the chess set").model;
    model.materials.extend(tori::materials());
    scenes::tori(kind, tube, &model)
}

/// Compares each ray of a picture of the ring with the exact first hit.
fn ring(size: &str, method: &str, tube: f32, distance: f32, more: &[&str]) -> Tally {
    seen(size, method, tube, (distance, None), more)
}

/// A piece of the ring, seen from 30 radii through a window of six tube radii: where it is, as `camera target`.
fn piece(method: &str, tube: f32, target: DVec3) -> Tally {
    let width = (2.0 * (3.0 * f64::from(tube) / 30.0).atan()).to_degrees();
    seen("64x64", method, tube, (30.0, Some((target, width))), &[])
}

fn seen(
    size: &str,
    method: &str,
    tube: f32,
    (distance, window): (f32, Option<(DVec3, f64)>),
    more: &[&str],
) -> Tally {
    let sets = [
        "scene=ring",
        &format!("tube={tube}"),
        &format!("distance={distance}"),
        &format!("method={method}"),
        "show=ray direction",
    ];
    let mut camera = scenes::camera(SceneKind::Ring, distance);
    let mut chapter = Chapter::new(NAME).size(size).sets(&sets).with(more);
    if let Some((target, width)) = window {
        (camera.target, camera.fov_y) = (target, width);
        let DVec3 { x, y, z } = target;
        chapter = chapter.set("camera target", format!("{x},{y},{z}")).set("field of view", width);
    }
    let shown = chapter.picture();
    let torus = exact(&scene(SceneKind::Ring, tube)[0]);
    let cases = rays(&camera, &shown).map(|ray| Case { ray, torus }).collect();
    let found = shown.pixels.iter().map(|pixel| {
        // The view has no normal: that of the exact hit stands for it.
        (pixel[3] >= 0.0).then_some(Found { t: pixel[3], normal: glam::DVec3::ZERO })
    });
    let tally = Tally::new(&Exact::new(cases), &found.collect::<Vec<_>>());
    row(&format!("{tube} {distance}"), method, &tally);
    tally
}

#[test]
fn the_top_method_is_right_when_traced() {
    for (tube, distance) in [(0.25, 30.0), (1e-2, 5.0), (1.0, 3.0), (0.25, 1e5)] {
        let tally = ring("64x64", "two-float", tube, distance, &[]);
        assert_eq!(tally.wrong(), 0, "{:?}", tally.first_wrong);
        assert!(tally.hits > 40 && tally.excused == 0, "{} {}", tally.hits, tally.excused);
        assert!(tally.ulp_at(1.0) <= 1.0, "{}", tally.ulp_at(1.0));
    }
}

#[test]
fn brackets_are_enough_for_a_ring() {
    let tally = ring("64x64", "brackets", 0.25, 30.0, &[]);
    assert!(tally.wrong() <= 1 && tally.ulp_at(0.99) <= 64.0, "{:?}", tally.first_wrong);
    // The same polynomial from the ray's origin.
    let far = ring("64x64", "brackets", 0.25, 30.0, &["--set", "conditioned=off"]);
    assert!(far.wrong() > 200, "{}", far.wrong());
}

/// The wire of the page's picture, at 45 and at 90 degrees along the ring from the point where the foot is on the tube.
#[test]
fn brackets_improve_a_thin_wire_and_two_floats_repair_it() {
    for target in [
        DVec3::new(0.5910208, -0.0470952, -0.8052803),
        DVec3::new(-0.1264763, 0.1541098, -0.9799255),
    ] {
        let [ferrari, brackets, top] = ["ferrari", "brackets", "two-float"]
            .map(|method| piece(method, 3e-4, target))
            .map(|tally| tally.wrong());
        assert!(top == 0 && brackets > 20 && ferrari > 2 * brackets, "{ferrari} {brackets} {top}");
    }
}

#[test]
#[ignore = "nightly: compiles for long; quick: roots::traced::the_top_method_is_right_when_traced"]
fn the_top_method_is_right_when_traced_in_the_worst_arithmetic() {
    if !has_worst_arithmetic() {
        return;
    }
    for (tube, distance) in [(0.25, 30.0), (1e-2, 5.0)] {
        let tally = ring("32x32", "two-float", tube, distance, &["--arithmetic", "worst"]);
        assert_eq!(tally.wrong(), 0, "{:?}", tally.first_wrong);
        assert!(tally.ulp_at(1.0) <= 1.0, "{}", tally.ulp_at(1.0));
    }
}

/// The nearest of all tori: where a torus is seen it is the right one, at the right distance.
#[test]
fn each_ray_of_the_chain_meets_the_nearest_torus() {
    let camera = scenes::camera(SceneKind::Chain, 0.0);
    let sets = ["method=two-float"];
    let chapter = || Chapter::new(NAME).size("96x60").sets(&sets);
    let [hits, directions] =
        ["hit", "ray direction"].map(|show| chapter().set("show", show).picture());
    let tori: Vec<_> = scene(SceneKind::Chain, 0.0).iter().map(exact).collect();
    let instance = Scene::chess().unwrap().instances.len() as u32;
    let mut found = 0;
    for (ray, pixel) in rays(&camera, &directions).zip(&hits.pixels) {
        let nearest = nearest(&ray, &tori);
        match answer(pixel) {
            Some(hit) if hit.instance == instance => {
                found += 1;
                let (number, t) = nearest.unwrap_or_else(|| panic!("{ray:?} hits no torus"));
                assert_eq!(hit.primitive as usize, number, "{ray:?}");
                let off = reference::ulp::ulp_error(hit.t, t);
                assert!(off <= 1.0, "{ray:?}: {off} ULP");
            }
            // A piece is nearer, or nothing is there.
            Some(hit) => assert!(nearest.is_none_or(|(_, t)| t >= f64::from(hit.t)), "{ray:?}"),
            None => assert!(nearest.is_none(), "{ray:?}: {nearest:?}"),
        }
    }
    assert!(found > 200, "{found}");
}

fn nearest(ray: &Ray, tori: &[Torus]) -> Option<(usize, f64)> {
    let may_hit = |torus: &Torus| {
        let f = torus.center - ray.origin;
        let apart = f.cross(ray.direction).length() / ray.direction.length();
        apart <= 1.01 * (torus.major + torus.minor)
    };
    let near = tori.iter().enumerate().filter(|(_, torus)| may_hit(torus));
    let hits = near.filter_map(|(i, torus)| Some((i, *torus.roots(ray, 0.0).first()?)));
    hits.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Shadow rays begin above the surface, and a ring casts no shadow where it has none.
#[test]
fn no_shadow_ray_meets_the_surface_it_leaves() {
    let light = Sun { azimuth: 60.0, elevation: 38.0, radiance: Vec3::ONE }.light().direction;
    for (tube, distance) in [(0.25f32, 30.0f32), (1.0, 3.0), (1e-3, 30.0)] {
        let look = if tube < 0.1 {
            &["camera target=0.9623059,-0.2207124,-0.1589129", "field of view=0.006"][..]
        } else {
            &[]
        };
        let sets = [
            "scene=ring",
            &format!("tube={tube}"),
            &format!("distance={distance}"),
            "sun azimuth=60",
            "sun elevation=38",
        ];
        let chapter = || Chapter::new(NAME).size("64x64").sets(&sets).sets(look);
        let [starts, normals] =
            ["shadow origin", "normal"].map(|show| chapter().set("show", show).picture());
        let torus = exact(&scene(SceneKind::Ring, tube)[0]);
        let (mut seen, mut own) = (0, 0);
        for (start, normal) in starts.pixels.iter().zip(&normals.pixels) {
            let [x, y, z, visible] = *start;
            if visible < 0.0 {
                continue;
            }
            seen += 1;
            let origin = Vec3::new(x, y, z).as_dvec3();
            assert!(torus.distance(origin) > 0.0, "{tube}: {origin} is below the surface");
            let normal = 2.0 * Vec3::from_slice(&normal[..3]) - 1.0;
            let ray = Ray { origin, direction: light.as_dvec3(), tmin: 0.0, tmax: 1e30 };
            // Where the light only grazes the surface, rounding may decide.
            let is_lit = normal.dot(light) > 0.02 && torus.roots(&ray, 0.0).is_empty();
            own += usize::from(is_lit && visible == 0.0);
        }
        println!("tube {tube}: {seen} hits, {own} shadows of their own");
        assert!(seen > 500 && own == 0, "{tube}: {own} of {seen}");
    }
}
