//! The growth of a box for which an intersection shader is called, and the rays lost although they hit it.

use anyhow::Result;
use common::gpu::Gpu;
use glam::{DVec3, Vec3};
use reference::aabb::Aabb;
use reference::random::Random;

use super::row::{Case, Row};
use super::seed;
use super::tracer::Tracer;
use super::truth::{Truth, ulp};
use super::world::World;
use crate::query::Ray;

/// The number of boxes in a world: as many as can be on one ray and be recorded.
const BOXES: usize = 8;

/// From the ray's origin to the box, and from the box to the world's origin.
const CASES: [(f64, f64); 9] = [
    (1.0, 0.0),
    (10.0, 0.0),
    (100.0, 0.0),
    (1e3, 0.0),
    (1e4, 0.0),
    (1e5, 0.0),
    (1e6, 0.0),
    (10.0, 1e3),
    (10.0, 1e6),
];

/// The error that 42 allows the device's test of a box: so many times 2^-24 of the distance to it.
const RELIED: f64 = 10.0;

/// Depth within the box of the deepest lost ray, by 2^-24 of the distance to the box's far side.
const DEEPEST: &str = "deepest lost, 2^-24 of way";

/// Measures `rays` rays a case.
///
/// # Errors
/// If the device fails.
pub fn row(gpu: &Gpu, tracer: &Tracer, rays: usize, exact: usize) -> Result<Row> {
    let mut truth = Truth::new(exact);
    let mut cases = Vec::new();
    for (distance, place) in CASES {
        cases.push(case(gpu, tracer, (distance, place), rays, &mut truth)?);
    }
    let kept = cases.iter().all(|case| case.number(DEEPEST) <= RELIED);
    let row = Row {
        row: "boxes",
        title: "How far a box grows",
        section: "Ray Intersection Candidate Determination",
        claim: "AABB primitive bounds consist of all points within an implementation-defined bound which includes \
                the specified box.",
        relied: "a box that is larger by 10 · 2^-24 of the way from the ray's origin loses no ray that meets the \
                 shape (08)",
        met: Some(cases.iter().all(|case| case.number("lost") == 0.0)),
        kept: Some(kept),
        cases,
        ..Row::default()
    };
    Ok(row.decided(&truth))
}

/// The growth needed for a ray to hit the box; below 0 for one that hits it already.
#[derive(Default)]
struct Growth {
    /// The largest for rays with a call of the intersection shader.
    offered: Option<f64>,
    /// The least for rays without one.
    refused: Option<f64>,
}

impl Growth {
    fn add(&mut self, growth: f64, is_offered: bool) {
        let least = |known: Option<f64>| known.map_or(growth, |known| known.min(growth));
        let most = |known: Option<f64>| known.map_or(growth, |known| known.max(growth));
        if is_offered {
            self.offered = Some(most(self.offered));
        } else {
            self.refused = Some(least(self.refused));
        }
    }
}

/// Counts of a case's rays by result.
#[derive(Default)]
struct Tally {
    meet: u64,
    lost: u64,
    beside: u64,
    /// In ULP of the way from the ray's origin to the box, and of the box's largest coordinate.
    way: Growth,
    coordinate: Growth,
    /// Depth within the box of the deepest lost ray, by 2^-24 of the distance.
    deepest: f64,
}

impl Tally {
    fn add(&mut self, truth: &mut Truth, ray: &Ray, walls: &[Vec3; 2], is_offered: bool) {
        let [low, high] = walls.map(|corner| corner.as_dvec3());
        let (growth, bound) = growth(ray, low, high);
        let meets = truth.decide(growth.abs() > bound, growth <= 0.0, || {
            Aabb { low, high }.intersect_exact(&ray.exact()).is_some()
        });
        self.meet += u64::from(meets);
        self.lost += u64::from(meets && !is_offered);
        self.beside += u64::from(!meets && is_offered);
        let origin = ray.origin.as_dvec3();
        let way =
            (origin - origin.clamp(low, high)).abs().max_element() + (high - low).max_element();
        let coordinate = low.abs().max(high.abs()).max_element();
        self.way.add(growth / ulp(way), is_offered);
        self.coordinate.add(growth / ulp(coordinate), is_offered);
        if meets && !is_offered {
            self.deepest = self.deepest.max(-growth / (way * 2f64.powi(-24)));
        }
    }
}

/// By how much the box would have to grow, each wall outwards, for the ray's line to touch it, and how far off
/// that may be. The ray enters the slab of axis i at `(a_i - g)/|d_i|` and leaves that of axis j at
/// `(b_j + g)/|d_j|`: it meets the box once no entry is later than an exit.
fn growth(ray: &Ray, low: DVec3, high: DVec3) -> (f64, f64) {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let ahead = |axis: usize| {
        let (near, far) = if d[axis] >= 0.0 { (low, high) } else { (high, low) };
        let sign = if d[axis] >= 0.0 { 1.0 } else { -1.0 };
        // Differences of f32 of such sizes: exact in 64 bits.
        (sign * (near[axis] - o[axis]), sign * (far[axis] - o[axis]))
    };
    let (mut growth, mut reach) = (f64::NEG_INFINITY, 0.0f64);
    for i in 0..3 {
        for j in 0..3 {
            let ((enter, _), (_, leave)) = (ahead(i), ahead(j));
            let (along, across) = (d[i].abs(), d[j].abs());
            growth = growth.max((enter * across - leave * along) / (along + across));
            reach = reach.max(enter.abs()).max(leave.abs());
        }
    }
    // Two products, their difference, a sum and a quotient.
    (growth, 4.0 * f64::EPSILON * reach)
}

/// A ray that passes near an edge of the box, across it, as near as 32 bits can tell at that distance.
fn ray(random: &mut Random, walls: &[Vec3; 2], distance: f64) -> Ray {
    let [low, high] = walls.map(|corner| corner.as_dvec3());
    let axis = random.below(3);
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut side = || if random.below(2) == 0 { -1.0 } else { 1.0 };
    let (to_b, to_c, to_side) = (side(), side(), side());
    let wall = |axis: usize, side: f64| if side > 0.0 { high[axis] } else { low[axis] };
    // Between the resolution of the nearer of the two and that of the farther.
    let coordinate = low.abs().max(high.abs()).max_element();
    let (fine, coarse) = (ulp(coordinate.min(distance)), ulp(coordinate.max(distance)));
    let beside = to_side * random.scale(0.0625 * fine, 64.0 * coarse);
    let mut edge = DVec3::ZERO;
    edge[axis] = low[axis] + (high[axis] - low[axis]) * random.between(0.2, 0.8);
    edge[b] = wall(b, to_b) + to_b * beside;
    edge[c] = wall(c, to_c) + to_c * beside;
    // It enters the one slab where it leaves the other.
    let mut along = DVec3::ZERO;
    along[axis] = random.between(-1.0, 1.0);
    along[b] = to_b * random.between(0.3, 1.0);
    along[c] = -to_c * random.between(0.3, 1.0);
    let along = along.normalize();
    let origin = (edge - along * (distance + 4.0)).as_vec3();
    let direction = (edge - origin.as_dvec3()).normalize().as_vec3();
    Ray { origin, direction, tmin: 0.0, tmax: 1e30 }
}

fn case(
    gpu: &Gpu,
    tracer: &Tracer,
    (distance, place): (f64, f64),
    count: usize,
    truth: &mut Truth,
) -> Result<Case> {
    let name = if place == 0.0 {
        format!("box from {distance}")
    } else {
        format!("box at {place} from {distance}")
    };
    let mut random = Random(seed("boxes", &name));
    let middle = random.unit() * place;
    let boxes: [[Vec3; 2]; BOXES] = std::array::from_fn(|_| {
        let half = DVec3::from_array([0; 3].map(|_| random.between(0.5, 1.5)));
        let at = middle + random.in_cube();
        [(at - half).as_vec3(), (at + half).as_vec3()]
    });
    let world = World::of_boxes(gpu, &boxes)?;
    let rays: Vec<Ray> =
        (0..count).map(|number| ray(&mut random, &boxes[number % BOXES], distance)).collect();
    let mut tally = Tally::default();
    tracer.trace(&world, &rays, |number, answer| {
        let asked = number % BOXES;
        let is_offered = answer.calls.iter().any(|met| met.primitive as usize == asked);
        tally.add(truth, &rays[number], &boxes[asked], is_offered);
    })?;
    let mut case = Case::new(name, count);
    case.tell("meet it", tally.meet);
    case.tell("lost", tally.lost);
    case.tell("offered beside it", tally.beside);
    for (growth, of) in [(tally.way, "way"), (tally.coordinate, "coordinate")] {
        case.tell(&format!("offered up to, ULP of {of}"), growth.offered);
        case.tell(&format!("refused from, ULP of {of}"), growth.refused);
    }
    case.tell(DEEPEST, tally.deepest);
    Ok(case)
}
