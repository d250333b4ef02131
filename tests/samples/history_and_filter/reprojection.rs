//! The previous pixel, against the same projection in 64 bits.

use std::f64::consts::PI;

use common::app::Picture;
use common::scene::Camera;
use glam::{DMat3, DVec2, DVec3};

use super::chapter;

const WIDTH: f64 = 96.0;
const HEIGHT: f64 = 64.0;

/// A piece that is under way.
struct Mover {
    scene: &'static str,
    /// The scene's own camera.
    camera: Camera,
    /// A frame in which it is fast.
    frame: u32,
    /// Where it is in that frame.
    middle: DVec3,
    /// Where its points were a frame earlier.
    before: fn(DVec3) -> DVec3,
}

/// Black's queen, who goes from e7 to e6 and turns half around.
fn queen() -> Mover {
    let camera = Camera::new(DVec3::new(6.4, 2.5, -2.7), DVec3::new(0.2, 0.3, -1.1), 33.0);
    Mover { scene: "chess", camera, frame: 20, middle: HOME + part(20) * DVec3::Z, before }
}

/// She starts at e7.
const HOME: DVec3 = DVec3::new(0.5, 0.0, -2.5);

/// The part of her way that she has gone.
fn part(frame: u32) -> f64 {
    0.5 - 0.5 * (PI * f64::from(frame) / 48.0).cos()
}

fn before(point: DVec3) -> DVec3 {
    let (now, then) = (part(20), part(19));
    let turn = DMat3::from_rotation_y((then - now) * PI);
    HOME + then * DVec3::Z + turn * (point - HOME - now * DVec3::Z)
}

/// White's knight, who flies from g1 to f3 in the frames from 154 on.
fn knight() -> Mover {
    let before = |point| point - flight(164) + flight(163);
    let camera = Camera::new(DVec3::new(7.2, 5.6, 7.0), DVec3::new(0.0, 0.3, 0.4), 38.0);
    Mover { scene: "game", camera, frame: 164, middle: flight(164), before }
}

/// The knight's place, by the rules of 14: up, across and down, each without a jerk.
fn flight(frame: u32) -> DVec3 {
    let smooth = |x: f64| x.clamp(0.0, 1.0).powi(2) * (3.0 - 2.0 * x.clamp(0.0, 1.0));
    let part = f64::from(frame - 154) / 34.0;
    let across = smooth((part - 0.2) / 0.6);
    let up = smooth(part / 0.35) * smooth((1.0 - part) / 0.35);
    DVec3::new(2.5, 0.0, 3.5) + across * DVec3::new(-1.0, 0.0, -2.0) + 2.3 * up * DVec3::Y
}

/// A camera of the chapter at a frame.
fn moved(camera: &Camera, frame: u32) -> Camera {
    // Controls are 32 bits wide.
    let [eye, target] = [camera.eye, camera.target].map(|point| point.as_vec3().as_dvec3());
    let turn = DMat3::from_rotation_y((0.25 * f64::from(frame)).to_radians());
    Camera { eye: target + turn * (eye - target), target, ..*camera }
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

fn shown(mover: &Mover, motion: &str, show: &str) -> Picture {
    let start = format!("frame={}", mover.frame - 1);
    let scene = format!("scene={}", mover.scene);
    let sets = [scene, format!("motion={motion}"), format!("show={show}"), start];
    chapter().sets(&sets).set("depth", 0).frames(2).picture()
}

/// The largest error in pixels, relative to its bound, and the number of pixels on the piece.
fn compare(mover: &Mover, motion: &str) -> (f64, usize) {
    let [hits, movements] = ["hit", "movement"].map(|show| shown(mover, motion, show));
    let before = moved(&mover.camera, if motion == "piece" { 0 } else { mover.frame - 1 });
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
            let pixels =
                rounding * HEIGHT / (2.0 * depth * (before.fov_y.to_radians() / 2.0).tan());
            // And the pixel itself has 24 bits.
            (found - expected).length() / (pixels + WIDTH * 2f64.powi(-22))
        };
        // A piece's points have moved with it or stood still, and those near its axis have moved.
        let apart = point - mover.middle;
        let inside = apart.y > 0.01 && DVec2::new(apart.x, apart.z).length() < 0.25;
        let (still, moving) = (error(point), error((mover.before)(point)));
        let is_on_piece = moves && (inside || moving < still);
        moved += usize::from(is_on_piece);
        worst = worst.max(if is_on_piece { moving } else { still });
    }
    println!("{motion}: {worst:.3} of the bound, {moved} pixels on the piece");
    (worst, moved)
}

#[test]
fn the_previous_pixel_is_that_of_64_bits() {
    for (mover, motion, on_piece) in [
        (queen(), "camera", 0),
        (queen(), "piece", 60),
        (queen(), "all", 60),
        (knight(), "piece", 20),
        (knight(), "all", 20),
    ] {
        let (worst, moved) = compare(&mover, motion);
        assert!(worst <= 1.0, "{motion}: {worst} times the bound");
        assert!(moved >= on_piece, "{motion}: {moved} pixels on the piece");
    }
}
