//! The crossing of rays: each passes through its point in focus, however far that point or the camera is.

use common::app::Picture;
use common::scene::Camera;
use glam::{DVec2, DVec3};
use serde_json::Map;

use super::{SMALL, chapter};
use run::{bits, expected};

/// Half the width of a picture 600 pixels high over that of one pixel, at distance 1.
fn pixels(camera: &Camera) -> f64 {
    300.0 / (camera.fov_y.to_radians() / 2.0).tan()
}

/// A camera that looks at a point 5 units away, and the corresponding settings.
fn camera(distance: f64) -> (Camera, [String; 3]) {
    let eye = distance * DVec3::new(0.6, 0.48, 0.64);
    let target = eye + DVec3::new(-4.0, 0.0, -3.0);
    let text = |name: &str, p: DVec3| format!("camera {name}={},{},{}", p.x, p.y, p.z);
    let sets = [text("eye", eye), text("target", target), "field of view=30".to_owned()];
    (Camera::new(eye, target, 30.0), sets)
}

/// The points where rays cross the plane in focus, seen from the eye: to the right and up, over the distance.
fn crossings(camera: &Camera, focus: f64, origins: &Picture, directions: &Picture) -> Vec<DVec2> {
    let eye = camera.eye.as_vec3().as_dvec3();
    let [right, up, forward] = camera.axes();
    let seen = |v: DVec3| (DVec2::new(v.dot(right), v.dot(up)), v.dot(forward));
    let vector = |p: &[f32; 4]| DVec3::new(p[0].into(), p[1].into(), p[2].into());
    let rays = origins.pixels.iter().zip(&directions.pixels);
    rays.map(|(origin, direction)| {
        let (aside, ahead) = seen(vector(origin) - eye);
        let (slope, depth) = seen(vector(direction));
        slope / depth * (1.0 - ahead / focus) + aside / focus
    })
    .collect()
}

/// The rays of one frame.
fn rays(sets: &[&str]) -> [Picture; 2] {
    ["show=ray origin", "show=ray direction"]
        .map(|show| chapter(SMALL).frames(2).sets(sets).sets(&[show]).picture())
}

/// The largest distance of a ray from its point in focus, in pixels of a picture 600 high.
fn off(distance: f64, focus: &str, rung: &str) -> f64 {
    let (camera, sets) = camera(distance);
    let [focus_set, rung] = [format!("focus distance={focus}"), format!("rung={rung}")];
    let sets: Vec<&str> = sets.iter().map(String::as_str).chain([&*focus_set, &*rung]).collect();
    let through = |diameter: &str, sets: &[&str]| {
        let [origins, directions] = rays(&[sets, &[diameter]].concat());
        crossings(&camera, focus.parse().expect("a number"), &origins, &directions)
    };
    // The ray through the middle of the lens equals a pinhole's, and gives the point in focus.
    let points = through("lens diameter=0", &[&sets[..4], &["rung=start"]].concat());
    let found = through("lens diameter=0.3", &sets);
    let off = points.iter().zip(&found).map(|(point, found)| (*point - *found).length());
    off.fold(0.0, f64::max) * pixels(&camera)
}

#[test]
#[ignore = "nightly: six places by three rungs; quick: depth_of_field::circle::what_is_in_focus_stays_sharp_with_any_lens"]
fn each_ray_passes_by_its_point_in_focus() {
    let mut table = Map::new();
    println!("| eye at | in focus at | world | eye | start |");
    for (distance, focus) in
        [(10.0, "0.1"), (10.0, "10"), (10.0, "1e6"), (1e4, "10"), (1e5, "10"), (1e6, "10")]
    {
        let [world, eye, start] = ["world", "eye", "start"].map(|rung| off(distance, focus, rung));
        println!("| {distance} | {focus} | {world:.5} | {eye:.5} | {start:.5} |");
        for (rung, value) in [("world", world), ("eye", eye), ("start", start)] {
            table.insert(format!("{distance},-{focus}.{rung}"), value.into());
        }
        // The direction is rounded after each of a handful of operations, to 2^-24 of itself; the picture has
        // 1120 pixels at distance 1, and its edge is one and a half times as far away.
        assert!(
            start < 1120.0 * 1.5 * 8.0 * 0.5f64.powi(24),
            "{distance}, {focus}: {start} pixels"
        );
        if distance == 1e6 {
            assert!(world > 1.0 && eye > 1.0, "{world} and {eye} pixels: nothing is lost");
        }
    }
    expected::hold("28_depth_of_field/rays", table.into());
}

#[test]
fn focused_at_infinity_the_rays_of_a_place_are_parallel() {
    let direction = |diameter| {
        let sets = ["focus distance=inf", "show=ray direction", diameter];
        // The fourth component is the distance of the hit.
        bits(&chapter(SMALL).frames(2).sets(&sets).picture())
            .into_iter()
            .map(|[x, y, z, _]| [x, y, z])
            .collect::<Vec<_>>()
    };
    assert!(direction("lens diameter=2") == direction("lens diameter=0"));
}

#[test]
fn every_rung_is_finite_at_every_focus() {
    for rung in ["rung=world", "rung=eye", "rung=start"] {
        for focus in ["focus distance=0.01", "focus distance=1e30", "focus distance=inf"] {
            for pixel in
                chapter(SMALL).frames(1).sets(&["show=ray direction", rung, focus]).picture().pixels
            {
                let length = pixel[..3].iter().map(|&c| f64::from(c).powi(2)).sum::<f64>();
                assert!((length - 1.0).abs() < 1e-6, "{rung} {focus}: {pixel:?}");
            }
        }
    }
}
