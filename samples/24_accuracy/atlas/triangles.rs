//! Errors of a hit's distance and barycentrics, by the triangle's distance, size, tilt, shape and place.

use anyhow::Result;
use common::gpu::Gpu;
use glam::{DVec3, Vec3};
use reference::random::Random;
use reference::ulp::ulp_error;

use super::errors::Errors;
use super::row::{Case, Row};
use super::seed;
use super::tracer::{Answer, Tracer};
use super::truth::{Hit, Truth, ulp};
use super::world::{Build, Corners, Traversal, World};
use crate::batch::IDENTITY;
use crate::query::Ray;

/// Triangles of a family, in worlds of eight: as many as can be on one ray and be recorded twice.
const WORLDS: usize = 8;
const TRIANGLES: usize = 8;

/// The error of a hit in the worst arithmetic, in ULP, with which the chapters are tested.
const MOVED: f64 = 16.0;

/// The names of the figures.
const T_PART: &str = "t, part of what is excused";
const WEIGHTS_PART: &str = "weights, part of what is excused";
const BEYOND: &str = "not excused";
const NOT_FINITE: &str = "not finite";

/// The pose of triangles before their rays.
#[derive(Clone, Copy)]
struct Family {
    /// The varied quantity, and its value.
    varied: &'static str,
    value: f64,
    /// From the ray's origin to the triangle.
    distance: f64,
    /// From the triangle's middle to its corners.
    size: f64,
    /// Degrees from the ray to the triangle's normal.
    tilt: f64,
    /// Its width by its length.
    width: f64,
    /// The distance of its middle from the world's origin.
    place: f64,
}

const PLAIN: Family = Family {
    varied: "distance",
    value: 10.0,
    distance: 10.0,
    size: 1.0,
    tilt: 30.0,
    width: 1.0,
    place: 0.0,
};

const DISTANCES: [f64; 6] = [1.0, 10.0, 100.0, 1e3, 1e4, 1e6];
const SIZES: [f64; 5] = [1e-6, 1e-4, 1e-2, 1e2, 1e4];
const TILTS: [f64; 6] = [0.0, 60.0, 80.0, 89.0, 89.9, 89.99];
const WIDTHS: [f64; 3] = [1e-2, 1e-4, 1e-6];
const PLACES: [f64; 3] = [1e2, 1e4, 1e6];

fn families() -> Vec<Family> {
    let distances = DISTANCES.map(|distance| Family { value: distance, distance, ..PLAIN });
    let sizes = SIZES.map(|size| Family { varied: "size", value: size, size, ..PLAIN });
    let tilts = TILTS.map(|tilt| Family { varied: "tilt", value: tilt, tilt, ..PLAIN });
    let widths = WIDTHS.map(|width| Family { varied: "width", value: width, width, ..PLAIN });
    let places = PLACES.map(|place| Family { varied: "place", value: place, place, ..PLAIN });
    [&distances[..], &sizes, &tilts, &widths, &places].concat()
}

/// Measures `rays` rays a family.
///
/// # Errors
/// If the device fails.
pub fn row(
    gpu: &Gpu,
    tracer: &Tracer,
    traversal: Traversal,
    rays: usize,
    exact: usize,
) -> Result<Row> {
    let mut truth = Truth::new(exact);
    let cases = families().into_iter().map(|family| {
        let name = format!("{} {}", family.varied, family.value);
        let mut random = Random(seed("triangles", &name));
        let mut tally = Tally::default();
        for world in 0..WORLDS {
            let count = rays / WORLDS + usize::from(world < rays % WORLDS);
            if count > 0 {
                family.ask(gpu, tracer, traversal, count, &mut random, &mut truth, &mut tally)?;
            }
        }
        Ok(tally.case(name, rays))
    });
    let cases = cases.collect::<Result<Vec<Case>>>()?;
    let is_kept = |case: &Case| {
        [T_PART, WEIGHTS_PART].iter().all(|part| case.number(part) <= 1.0)
            && case.number(BEYOND) == 0.0
            && case.number(NOT_FINITE) == 0.0
    };
    let kept = cases.iter().all(is_kept);
    Ok(Row {
        row: "triangles",
        title: "How exact a hit is",
        section: "Ray Intersection Candidate Determination",
        claim: "Due to the complexity and number of operations involved, inaccuracies are expected, particularly \
                as the scale of values involved begins to diverge. Implementations should take efforts to \
                maintain as much precision as possible.",
        relied: "the bound of common/reference/src/bound.rs, how far a test in 32-bit floats may be off, and 16 ULP \
                 of t and 16 ULP of 1 for weights besides, by which --arithmetic worst moves them: tests of \
                 pictures excuse no more",
        kept: Some(kept),
        cases,
        ..Row::default()
    }
    .decided(&truth))
}

/// Counts for a family.
#[derive(Default)]
struct Tally {
    t: Errors,
    weights: Errors,
    weights_ulp: Errors,
    /// The largest errors by what is excused.
    t_part: f64,
    weights_part: f64,
    missed: u64,
    beside: u64,
    /// The numbers of missed triangles and of hit neighbours without an excuse.
    beyond: u64,
    not_finite: u64,
    differ: u64,
}

impl Tally {
    fn case(self, name: String, rays: usize) -> Case {
        let mut case = Case::new(name, rays);
        case.spread("t", self.t);
        case.spread("weights", self.weights);
        case.spread("weights ULP", self.weights_ulp);
        case.tell(T_PART, self.t_part);
        case.tell(WEIGHTS_PART, self.weights_part);
        case.tell("missed", self.missed);
        case.tell("hit beside", self.beside);
        case.tell(BEYOND, self.beyond);
        case.tell("nearest differs", self.differ);
        case.tell(NOT_FINITE, self.not_finite);
        case
    }
}

impl Family {
    #[allow(clippy::too_many_arguments, reason = "what is asked, whom, and where it is counted")]
    fn ask(
        &self,
        gpu: &Gpu,
        tracer: &Tracer,
        traversal: Traversal,
        count: usize,
        random: &mut Random,
        truth: &mut Truth,
        tally: &mut Tally,
    ) -> Result<()> {
        let middle = random.unit() * self.place;
        let made: [(DVec3, Corners); TRIANGLES] =
            std::array::from_fn(|_| self.triangle(random, middle));
        let corners = made.map(|(_, corners)| corners);
        let world = World::of_triangles(gpu, traversal, &corners, &IDENTITY, Build::default())?;
        let rays: Vec<Ray> =
            (0..count).map(|number| self.ray(random, &made[number % TRIANGLES])).collect();
        tracer.trace(&world, &rays, |number, answer| {
            let asked = number % TRIANGLES;
            tally.add(truth, &rays[number], asked, &corners[asked], answer);
        })
    }

    /// A triangle, and the direction in which its rays go.
    fn triangle(&self, random: &mut Random, middle: DVec3) -> (DVec3, Corners) {
        let along = random.unit();
        let across = along.cross(random.unit()).normalize();
        let (sine, cosine) = self.tilt.to_radians().sin_cos();
        let normal = -along * cosine + across * sine;
        let long = across * cosine + along * sine;
        let wide = normal.cross(long);
        let turn = random.between(0.0, std::f64::consts::TAU);
        let corner = |k: usize| {
            let angle = turn + (k as f64 * 120.0 + random.between(-20.0, 20.0)).to_radians();
            let at = self.size * (angle.cos() * long + self.width * angle.sin() * wide);
            (middle + at).as_vec3()
        };
        let [a, b, c] = [0, 1, 2].map(corner);
        (along, [a, b, c])
    }

    /// A ray at a point of the triangle that is not right at its border.
    fn ray(&self, random: &mut Random, (along, corners): &(DVec3, Corners)) -> Ray {
        let (p, q) = (random.between(0.05, 0.9), random.between(0.05, 0.9));
        let (p, q) = if p + q > 0.95 { (0.95 - p, 0.95 - q) } else { (p, q) };
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let target = a * (1.0 - p - q) + b * p + c * q;
        let origin = (target - *along * self.distance * random.between(0.75, 1.25)).as_vec3();
        let direction = (target - origin.as_dvec3()).normalize().as_vec3();
        Ray { origin, direction, tmin: 0.0, tmax: 1e30 }
    }
}

impl Tally {
    fn add(
        &mut self,
        truth: &mut Truth,
        ray: &Ray,
        asked: usize,
        corners: &[Vec3; 3],
        answer: &Answer,
    ) {
        let (exact, off) = truth.hit(&ray.exact(), &corners.map(|corner| corner.as_dvec3()));
        let nearest = answer.calls.iter().map(|met| met.t).min_by(f32::total_cmp);
        let bits = |t: Option<f32>| t.map(f32::to_bits);
        self.differ += u64::from(bits(nearest) != bits(answer.nearest.map(|met| met.t)));
        let met = answer.calls.iter().find(|met| met.primitive as usize == asked);
        let (met, Hit { t, weights }) = match (met, exact) {
            (Some(met), Some(exact)) => (met, exact),
            (None, None) => return,
            (met, _) => {
                let excused = if met.is_some() { off.may_hit } else { off.may_miss };
                self.beyond += u64::from(!excused);
                self.missed += u64::from(met.is_none());
                self.beside += u64::from(met.is_some());
                return;
            }
        };
        if !(met.t.is_finite() && met.barycentrics.is_finite()) {
            return self.not_finite += 1;
        }
        self.t.add(ulp_error(met.t, t));
        self.t_part = self.t_part.max((f64::from(met.t) - t).abs() / (off.t + MOVED * ulp(t)));
        for (k, weight) in met.barycentrics.to_array().into_iter().enumerate() {
            let error = (f64::from(weight) - weights[k]).abs();
            self.weights.add(error * f64::from(1 << 24));
            self.weights_ulp.add(ulp_error(weight, weights[k]));
            self.weights_part = self.weights_part.max(error / (off.weights[k] + MOVED * ulp(1.0)));
        }
    }
}
