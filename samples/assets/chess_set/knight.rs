//! The knight: a horse's head, modelled as a signed distance that smoothly joins simple bodies,
//! on a turned foot. It looks towards +x.
//!
//! All coordinates are (x, y) in the plane of symmetry, with a third where a part lies beside it;
//! the function takes the absolute value of z, so that every part there counts for both sides.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4, dvec3, dvec4};

use crate::cut;
use crate::lathe::on_circle;
use crate::mesh::Mesh;
use crate::nets::{self, Grid};
use crate::pieces::foot;

/// The height of the foot, which supports the neck.
const FOOT: f64 = 0.335;

/// Spines as (x, y, radius, half the thickness): where the body is in the plane of symmetry, how
/// far it reaches in that plane, and how far to the sides.
const NECK: [DVec4; 6] = [
    dvec4(0.000, 0.28, 0.225, 0.215),
    dvec4(0.018, 0.46, 0.228, 0.200),
    dvec4(-0.015, 0.66, 0.208, 0.172),
    dvec4(-0.075, 0.87, 0.178, 0.145),
    dvec4(-0.085, 1.10, 0.162, 0.124),
    dvec4(0.000, 1.285, 0.130, 0.105),
];
const HEAD: [DVec4; 5] = [
    dvec4(0.000, 1.300, 0.135, 0.104),
    dvec4(0.090, 1.240, 0.135, 0.110),
    dvec4(0.195, 1.145, 0.105, 0.090),
    dvec4(0.290, 1.050, 0.083, 0.074),
    dvec4(0.335, 1.005, 0.078, 0.076),
];
const MANE: [DVec4; 7] = [
    dvec4(0.085, 1.405, 0.030, 0.034),
    dvec4(-0.030, 1.430, 0.060, 0.055),
    dvec4(-0.145, 1.360, 0.082, 0.068),
    dvec4(-0.230, 1.200, 0.092, 0.076),
    dvec4(-0.250, 0.975, 0.092, 0.078),
    dvec4(-0.218, 0.750, 0.080, 0.070),
    dvec4(-0.180, 0.580, 0.055, 0.055),
];
/// Number of the mane's locks between two points of its spine.
const LOCKS: f64 = 1.5;

/// The knight.
pub fn knight() -> Mesh {
    const SEGMENTS: u32 = 28;
    let grid = Grid { low: dvec3(-0.47, 0.2, -0.315), high: dvec3(0.5, 1.7, 0.315), cell: 0.0315 };
    // The lower end is closed too, below the cut.
    let head = nets::surface(&grid, |p| distance(p).max(0.26 - p.y));
    let (head, opening) = cut::above(head, FOOT);
    let foot = foot(0.36, 0.76, FOOT);
    let ring: Vec<_> = (0..SEGMENTS)
        .map(|i| on_circle(foot.end(), TAU * f64::from(i) / f64::from(SEGMENTS)))
        .collect();
    let mut mesh = foot.turn(SEGMENTS);
    mesh.bridge(&ring, &opening);
    mesh.append(head);
    mesh
}

/// About the distance from the head's surface, negative inside.
fn distance(p: DVec3) -> f64 {
    let p = dvec3(p.x, p.y, p.z.abs());
    let (neck, _) = spine(p, &NECK);
    let (head, _) = spine(p, &HEAD);
    let (mane, along) = spine(p, &MANE);

    let mut body = smooth_min(neck, head, 0.08);
    // Cheek, brow and the bulge of the nostril.
    body = smooth_min(body, ellipsoid(p, [0.065, 1.165, 0.050], [0.125, 0.135, 0.080]), 0.04);
    body = smooth_min(body, ellipsoid(p, [0.130, 1.310, 0.072], [0.065, 0.030, 0.042]), 0.05);
    body = smooth_min(body, ellipsoid(p, [0.365, 1.030, 0.045], [0.050, 0.042, 0.038]), 0.04);
    // The lower jaw.
    body = smooth_min(body, ellipsoid(p, [0.275, 0.958, 0.0], [0.085, 0.042, 0.056]), 0.05);
    // The locks of the mane: a wave that leans to one side and runs aslant.
    let lock = TAU * (LOCKS * along - 3.0 * p.z);
    let wave = 0.0085 * (lock + 0.6 * lock.cos()).sin();
    body = smooth_min(body, mane - wave, 0.03);
    // The ear: a cone, hollow in front.
    let ear = cone(p, [0.005, 1.37, 0.064], [0.030, 1.510, 0.084], 0.062, 0.030);
    let hollow = cone(p, [0.088, 1.40, 0.100], [0.088, 1.48, 0.105], 0.032, 0.018);
    body = smooth_min(body, smooth_max(ear, -hollow, 0.04), 0.03);
    // The eye in its socket, the nostril and the mouth.
    body = smooth_max(body, -ball(p, [0.152, 1.252, 0.152], 0.050), 0.05);
    body = smooth_min(body, ball(p, [0.146, 1.252, 0.086], 0.038), 0.015);
    body = smooth_max(body, -ball(p, [0.392, 1.040, 0.088], 0.022), 0.025);
    let mouth = cone(dvec3(p.x, p.y, 0.0), [0.29, 0.982, 0.0], [0.45, 0.960, 0.0], 0.0, 0.0);
    body + 0.014 * (-(mouth / 0.016).powi(2)).exp()
}

/// The distance from a tube around a spine, and the place along it, in points.
fn spine(p: DVec3, points: &[DVec4]) -> (f64, f64) {
    const STEPS: usize = 6;
    let mut best = (f64::INFINITY, 0.0);
    let mut last = points[0];
    for i in 0..(points.len() - 1) * STEPS {
        let along = (i + 1) as f64 / STEPS as f64;
        let next = catmull_rom(points, along);
        let (a, b) = (last.truncate().truncate(), next.truncate().truncate());
        let t = ((p.truncate() - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let here = last.lerp(next, t);
        let in_plane = p.truncate().distance(DVec2::new(here.x, here.y));
        // An ellipse: lengths to the side are scaled to those in the plane.
        let scaled = in_plane.hypot(p.z * here.z / here.w);
        let distance = (scaled - here.z) * (here.w / here.z).min(1.0);
        if distance < best.0 {
            best = (distance, along - (1.0 - t) / STEPS as f64);
        }
        last = next;
    }
    best
}

/// The curve through all points, at `along` counted in points.
fn catmull_rom(points: &[DVec4], along: f64) -> DVec4 {
    let i = (along as usize).min(points.len() - 2);
    let t = along - i as f64;
    let [a, b, c, d] =
        [i.saturating_sub(1), i, i + 1, (i + 2).min(points.len() - 1)].map(|index| points[index]);
    let (m, n) = ((c - a) / 2.0, (d - b) / 2.0);
    let (s, u) = (t * t, t * t * t);
    b * (2.0 * u - 3.0 * s + 1.0) + m * (u - 2.0 * s + t) + c * (3.0 * s - 2.0 * u) + n * (u - s)
}

/// About the distance from an ellipsoid.
fn ellipsoid(p: DVec3, centre: [f64; 3], radii: [f64; 3]) -> f64 {
    let (offset, radii) = (p - DVec3::from(centre), DVec3::from(radii));
    let scaled = (offset / radii).length();
    scaled * (scaled - 1.0) / (offset / (radii * radii)).length().max(1e-9)
}

/// The distance from a ball.
fn ball(p: DVec3, centre: [f64; 3], radius: f64) -> f64 {
    p.distance(centre.into()) - radius
}

/// About the distance from a cone with round ends between two points.
fn cone(p: DVec3, a: [f64; 3], b: [f64; 3], radius_a: f64, radius_b: f64) -> f64 {
    let (a, b) = (DVec3::from(a), DVec3::from(b));
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a.lerp(b, t)) - (radius_a + (radius_b - radius_a) * t)
}

/// The smaller of two, rounded where they differ by less than `round`.
fn smooth_min(a: f64, b: f64, round: f64) -> f64 {
    let overlap = (1.0 - (a - b).abs() / round).max(0.0);
    a.min(b) - overlap * overlap * overlap * round / 6.0
}

/// The greater of two, rounded where they differ by less than `round`.
fn smooth_max(a: f64, b: f64, round: f64) -> f64 {
    -smooth_min(-a, -b, round)
}
