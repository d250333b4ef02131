//! The time for which each pixel sees a moving object: a ball by its closed form, a turning knight at 1,024
//! times.

use std::f64::consts::PI;

use common::app::Picture;
use common::model::obj;
use common::scene::{Camera, assets};
use glam::{DQuat, DVec3};
use run::expected;
use serde_json::{Value, json};

use super::leg::Motion;
use super::motion::Placed;
use super::{ball, chapter, legs};

const BALL: f64 = 0.5;
const SHUTTER: f64 = 2.0;

fn camera() -> Camera {
    Camera::new(DVec3::new(-6.3, 4.6, 10.9), DVec3::new(0.6, 1.35, -0.6), 38.5)
}

/// The only piece, when the shutter opens in a frame and when it closes.
fn ends(motion: &Motion, frame: u32) -> [Placed; 2] {
    [0.0, SHUTTER].map(|after| motion.at(f64::from(frame) + after, 1).next().unwrap())
}

/// The rays of all pixels, and the fraction of the shutter's time for which each sees the moving object.
fn seen(file: &str, size: &str, sets: &[&str]) -> (Vec<(DVec3, DVec3)>, Vec<f64>) {
    let of = |show: &str| -> Picture {
        chapter(size).scene(file).sets(&["shutter=2", show]).sets(sets).picture()
    };
    let eye = camera().eye.as_vec3().as_dvec3();
    let directions = of("show=ray direction");
    let rays = directions
        .pixels
        .iter()
        .map(|&[x, y, z, _]| (eye, DVec3::new(x.into(), y.into(), z.into())));
    let smear = of("show=smear").pixels.iter().map(|pixel| f64::from(pixel[0])).collect();
    (rays.collect(), smear)
}

/// The part of the time from 0 to 1 in which a line hits a ball that moves by `way`: that where |(o - c)×d|
/// is less than the radius times |d|, a quadratic in the time.
fn met((o, d): (DVec3, DVec3), center: DVec3, way: DVec3, radius: f64) -> f64 {
    let (from, by) = ((o - center).cross(d), -way.cross(d));
    let (a, b) = (by.length_squared(), from.dot(by));
    let c = from.length_squared() - radius * radius * d.length_squared();
    let discriminant = b * b - a * c;
    if discriminant <= 0.0 {
        return 0.0;
    }
    let [first, last] =
        [-1.0, 1.0].map(|side| ((-b + side * discriminant.sqrt()) / a).clamp(0.0, 1.0));
    last - first
}

/// The ball is made of triangles between two spheres. So each pixel sees it for at least as long as the inner
/// sphere, and at most as long as the outer one; each end of that time may cost a sample.
#[test]
fn the_smear_of_a_ball_is_its_closed_form() {
    smears_of_a_ball("192x120", 64);
}

#[test]
#[ignore = "nightly: 256 samples per pixel; quick: motion_blur::smear::the_smear_of_a_ball_is_its_closed_form"]
fn so_it_is_by_more_samples() {
    expected::hold("23_motion_blur/ball", smears_of_a_ball("192x120", 256));
}

/// Compares a picture of each method with the closed form; returns the differences.
fn smears_of_a_ball(size: &str, samples: u32) -> Value {
    let file = run::root().join("tests/data/ball.legs");
    let motion = legs::open(&file).unwrap();
    let [open, close] = ends(&motion, 16).map(|placed| placed.place.as_dvec3() + BALL * DVec3::Y);
    // Between two vertices, along and around, is half the angle of a cell.
    let half = (PI / (2.0 * f64::from(ball::ROWS))).cos();
    let inner = BALL * half * half;
    let mut held = json!({});
    for (method, lost) in [("swept", 2.0 / f64::from(samples)), ("moments", 2.0 / 8.0)] {
        let sets = ["frame=16", &format!("method={method}"), &format!("samples={samples}")];
        let (rays, smear) = seen(file.to_str().unwrap(), size, &sets);
        let (mut largest, mut sum, mut partly) = (0f64, 0.0, 0);
        for (at, (&ray, &seen)) in rays.iter().zip(&smear).enumerate() {
            let [least, most] = [inner, BALL].map(|radius| met(ray, open, close - open, radius));
            // And 1e-5 for the mean of samples and the ball's own rounding.
            let room = lost + 1e-5;
            assert!(
                seen > least - room && seen < most + room,
                "{method}, pixel {at}: {least} {seen} {most}"
            );
            if most > 0.0 && most < 1.0 {
                largest = largest.max((seen - most).abs());
                sum += (seen - most).powi(2);
                partly += 1;
            }
        }
        let error = (sum / f64::from(partly)).sqrt();
        println!("{method}: {partly} pixels, error {error}, at most {largest}");
        assert!(partly > 200, "{partly}");
        held[format!("{method}-pixels")] = json!(partly);
        held[format!("{method}-error")] = json!(error);
        held[format!("{method}-largest")] = json!(largest);
    }
    held
}

/// Half the angle from one unit quaternion to the mix of two at an angle of `half`.
fn mixed(half: f64, time: f64) -> f64 {
    (time * half.sin()).atan2(1.0 - time + time * half.cos())
}

/// A knight that flies and turns, compared with its triangles in 64 bits at 1,024 times, moved by an
/// independent formula.
#[test]
#[ignore = "nightly: 1,024 samples per pixel; quick: motion_blur::smear::the_smear_of_a_ball_is_its_closed_form"]
fn the_smear_of_a_knight_is_that_of_1024_times() {
    const TIMES: u32 = 1024;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("knight.legs");
    std::fs::write(&file, "last 60\npiece white knight -2 0 0.5\nleg 0 0 2 0 0.5 2\n").unwrap();
    let motion = legs::open(&file).unwrap();
    let [open, close] = ends(&motion, 16);
    let half = 0.5 * f64::from(close.yaw - open.yaw).to_radians();
    let model = obj::load(&assets().join("chess.obj")).unwrap();
    let mesh = model.meshes.iter().find(|mesh| mesh.name == "knight").unwrap();
    let triangles: Vec<[DVec3; 3]> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(|index| mesh.vertices[index as usize].position.as_dvec3()))
        .collect();
    let samples = format!("samples={TIMES}");
    let (rays, smear) = seen(file.to_str().unwrap(), "96x60", &["frame=16", &samples]);
    let (mut compared, mut largest, mut sum) = (0, 0f64, 0.0);
    let partly = rays.iter().zip(&smear).filter(|(_, seen)| **seen > 0.0 && **seen < 1.0);
    for (&(o, d), &seen) in partly {
        let (mut count, mut edges, mut before) = (0u32, 0u32, None);
        for i in 0..TIMES {
            let time = (f64::from(i) + 0.5) / f64::from(TIMES);
            let place = open.place.as_dvec3().lerp(close.place.as_dvec3(), time);
            let yaw = f64::from(open.yaw).to_radians() + 2.0 * mixed(half, time);
            // The ray is transformed to the knight rather than the knight to the ray.
            let back = DQuat::from_rotation_y(-yaw);
            let (o, d) = (back * (o - place), back * d);
            let hit = triangles.iter().any(|&[a, b, c]| meets(o, d, a, b, c));
            edges += u32::from(before.is_some_and(|before| before != hit));
            count += u32::from(hit);
            before = Some(hit);
        }
        let exact = f64::from(count) / f64::from(TIMES);
        // Each edge is passed within a part of 1/1,024, where either count may be off by one; an edge passed
        // twice within a part may be missed by both counts.
        let room = f64::from(2 * edges + 2) / f64::from(TIMES);
        assert!((seen - exact).abs() <= room, "{seen} {exact}: {edges} edges");
        largest = largest.max((seen - exact).abs());
        sum += (seen - exact).powi(2);
        compared += 1;
    }
    let error = (sum / f64::from(compared)).sqrt();
    println!(
        "{compared} pixels, error {error}, at most {largest}; turned by {} degrees",
        close.yaw - open.yaw
    );
    assert!(compared > 60, "{compared}");
    let turned = close.yaw - open.yaw;
    expected::hold(
        "23_motion_blur/knight",
        json!({ "pixels": compared, "error": error, "largest": largest, "degrees": turned }),
    );
}

/// Returns whether a ray hits a triangle (Möller and Trumbore 1997, which the shader does not use).
fn meets(o: DVec3, d: DVec3, a: DVec3, b: DVec3, c: DVec3) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let determinant = e1.dot(p);
    if determinant == 0.0 {
        return false;
    }
    let s = o - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(e1);
    let v = d.dot(q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && e2.dot(q) / determinant > 0.0
}
