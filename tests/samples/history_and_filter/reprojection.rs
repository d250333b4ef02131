//! The previous pixel, against the same projection in 64 bits.

use std::f64::consts::PI;

use common::app::Picture;
use common::scene::Camera;
use glam::{DMat3, DVec2, DVec3};

use super::chapter;

/// A frame in which the piece is fast, and the frame before.
const FRAME: u32 = 20;
const WIDTH: f64 = 96.0;
const HEIGHT: f64 = 64.0;

/// The camera of the chapter at a frame.
fn camera(frame: u32) -> Camera {
    let (eye, target) = (DVec3::new(6.4, 2.5, -2.7), DVec3::new(0.2, 0.3, -1.1));
    // Controls are 32 bits wide.
    let [eye, target] = [eye, target].map(|point| point.as_vec3().as_dvec3());
    let turn = DMat3::from_rotation_y((0.25 * f64::from(frame)).to_radians());
    Camera::new(target + turn * (eye - target), target, 33.0)
}

/// Where a camera sees a point, in pixels.
fn project(camera: &Camera, point: DVec3) -> (DVec2, f64) {
    let [right, up, forward] = camera.axes();
    let from_eye = point - camera.eye;
    let depth = from_eye.dot(forward);
    let half_height = (camera.fov_y.to_radians() / 2.0).tan();
    let side = DVec2::new(from_eye.dot(right) / (WIDTH / HEIGHT), -from_eye.dot(up));
    ((0.5 + 0.5 * side / (depth * half_height)) * DVec2::new(WIDTH, HEIGHT), depth)
}

/// A point of the queen at `FRAME`, a frame earlier. She starts at e7.
fn a_frame_before(point: DVec3) -> DVec3 {
    let home = DVec3::new(0.5, 0.0, -2.5);
    let part = |frame: u32| 0.5 - 0.5 * (PI * f64::from(frame) / 48.0).cos();
    let (now, then) = (part(FRAME), part(FRAME - 1));
    let turn = DMat3::from_rotation_y((then - now) * PI);
    home + then * DVec3::Z + turn * (point - home - now * DVec3::Z)
}

fn shown(motion: &str, show: &str) -> Picture {
    let start = format!("frame={}", FRAME - 1);
    let sets = [format!("motion={motion}"), format!("show={show}"), start];
    chapter().sets(&sets).set("depth", 0).frames(2).picture()
}

/// The largest error in pixels, relative to its bound, and the number of pixels on the queen.
fn compare(motion: &str) -> (f64, usize) {
    let [hits, movements] = ["hit", "movement"].map(|show| shown(motion, show));
    let before = if motion == "piece" { camera(0) } else { camera(FRAME - 1) };
    let moves = motion != "camera";
    let (mut worst, mut moved) = (0.0f64, 0);
    for (index, (hit, movement)) in hits.pixels.iter().zip(&movements.pixels).enumerate() {
        let point = DVec3::new(hit[0].into(), hit[1].into(), hit[2].into());
        if point == DVec3::ZERO {
            continue; // the sky
        }
        let pixel = DVec2::new((index % 96) as f64, (index / 96) as f64) + 0.5;
        let found = pixel - DVec2::new(movement[0].into(), movement[1].into());
        // The error of a point's coordinates is that of a few sums of four terms, 32 roundings of the largest; seen
        // from the eye it is so many pixels.
        let error = |point: DVec3| {
            let (expected, depth) = project(&before, point);
            let rounding =
                32.0 * 2f64.powi(-24) * (point.abs().max_element() + before.eye.length());
            let pixels = rounding * HEIGHT / (2.0 * depth * (33f64.to_radians() / 2.0).tan());
            // And the pixel itself has 24 bits.
            (found - expected).length() / (pixels + WIDTH * 2f64.powi(-22))
        };
        // A piece's points have moved with it or stood still, and those near her axis have moved.
        let middle = DVec3::new(0.5, 0.0, -2.5 + 0.5 - 0.5 * (PI * f64::from(FRAME) / 48.0).cos());
        let apart = point - middle;
        let inside = point.y > 0.01 && DVec2::new(apart.x, apart.z).length() < 0.25;
        let (still, moving) = (error(point), error(a_frame_before(point)));
        let is_queen = moves && (inside || moving < still);
        moved += usize::from(is_queen);
        worst = worst.max(if is_queen { moving } else { still });
    }
    println!("{motion}: {worst:.3} of the bound, {moved} pixels on the queen");
    (worst, moved)
}

#[test]
fn the_previous_pixel_is_that_of_64_bits() {
    for (motion, on_queen) in [("camera", 0), ("piece", 60), ("all", 60)] {
        let (worst, moved) = compare(motion);
        assert!(worst <= 1.0, "{motion}: {worst} times the bound");
        assert!(moved >= on_queen, "{motion}: {moved} pixels on the queen");
    }
}
