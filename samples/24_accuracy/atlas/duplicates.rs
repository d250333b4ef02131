//! Two identical triangles in one place: which of them a ray hits, and how often any-hit shaders are called.

use std::collections::HashMap;

use anyhow::Result;
use common::gpu::Gpu;
use glam::DVec3;
use reference::random::Random;

use super::row::{Case, Row};
use super::seed;
use super::tracer::{Answer, Tracer};
use super::truth::Truth;
use super::world::{Build, Corners, Traversal, World};
use crate::batch::IDENTITY;
use crate::query::Ray;

/// Triangles that occur twice: the one surrounded by many small ones is large.
const PAIRS: usize = 64;

/// Measures `rays` rays with the flag that forbids a second call, and without it.
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
    let mut cases = Vec::new();
    for (name, no_duplicates) in [("without the flag", false), ("with the flag", true)] {
        let build = Build { no_duplicates, ..Build::default() };
        cases.push(case(gpu, tracer, traversal, name, build, rays, &mut truth)?);
    }
    let once = cases.iter().find(|case| case.case == "with the flag");
    let kept = once.is_some_and(|case| case.number("called again") == 0.0);
    let row = Row {
        row: "duplicates",
        title: "Two triangles in one place",
        section: "Ray Closest Hit Determination; Triangle and Generated Intersection Candidates",
        claim: "If t = tmax, the candidate may be set as the current closest hit or dropped. … This operation may \
                be executed multiple times for the same intersection candidate unless \
                VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR was specified for the intersected geometry.",
        relied: "with the flag, one call a triangle (03). Which of two equal triangles is hit, no chapter cares",
        met: (traversal == Traversal::Device).then_some(kept),
        // The software's boxes have no such flag.
        kept: (traversal == Traversal::Device).then_some(kept),
        unavailable: (traversal == Traversal::Software)
            .then(|| "boxes have no such flag".to_owned()),
        cases,
        ..Row::default()
    };
    Ok(row.decided(&truth))
}

/// Triangles of all sizes and shapes, long ones among them, which a device may cut into pieces.
fn triangles(random: &mut Random) -> Vec<Corners> {
    let triangle = |number: usize| {
        let size = if number.is_multiple_of(8) { 8.0 } else { random.scale(0.1, 2.0) };
        let width = if number.is_multiple_of(3) { 0.02 } else { 1.0 };
        let middle = random.in_cube() * 8.0;
        let (u, v) = (random.unit(), random.unit());
        let corner = |x: f64, y: f64| (middle + size * (x * u + width * y * v)).as_vec3();
        [corner(-1.0, -0.5), corner(1.0, -0.4), corner(0.1, 1.0)]
    };
    (0..PAIRS).map(triangle).collect()
}

fn case(
    gpu: &Gpu,
    tracer: &Tracer,
    traversal: Traversal,
    name: &str,
    build: Build,
    count: usize,
    truth: &mut Truth,
) -> Result<Case> {
    // The same triangles and rays, with the flag or without.
    let mut random = Random(seed("duplicates", ""));
    let once = triangles(&mut random);
    let both = [&once[..], &once].concat();
    let world = World::of_triangles(gpu, traversal, &both, &IDENTITY, build)?;
    let rays: Vec<Ray> = (0..count).map(|number| ray(&mut random, &once[number % PAIRS])).collect();
    let mut tally = Tally::default();
    let mut nearest = Vec::with_capacity(count);
    tracer.trace(&world, &rays, |number, answer| {
        let asked = number % PAIRS;
        let corners = once[asked].map(|corner| corner.as_dvec3());
        let is_hit = truth.hit(&rays[number].exact(), &corners).0.is_some();
        tally.add(answer, asked, is_hit);
        nearest.push(answer.nearest.map(|met| met.primitive));
    })?;
    tracer.trace(&world, &rays, |number, answer| {
        tally.other += u64::from(answer.nearest.map(|met| met.primitive) != nearest[number]);
    })?;
    let mut case = Case::new(name, count);
    case.tell("first wins", tally.first);
    case.tell("second wins", tally.second);
    case.tell("other the next time", tally.other);
    case.tell("t differs", tally.differ);
    case.tell("never called", tally.never);
    case.tell("called", tally.called);
    case.tell("called again", tally.again);
    case.tell("most calls", tally.most);
    case.tell("beyond 16 calls", tally.beyond);
    Ok(case)
}

/// A ray at a point within a triangle.
fn ray(random: &mut Random, corners: &Corners) -> Ray {
    let (p, q) = (random.between(0.05, 0.45), random.between(0.05, 0.45));
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let target = a * (1.0 - p - q) + b * p + c * q;
    let origin: DVec3 = target + random.unit() * random.between(1.0, 10.0);
    let origin = origin.as_vec3();
    let direction = (target - origin.as_dvec3()).normalize().as_vec3();
    Ray { origin, direction, tmin: 0.0, tmax: 1e30 }
}

/// Counts of a case's rays by result.
#[derive(Default)]
struct Tally {
    first: u64,
    second: u64,
    other: u64,
    differ: u64,
    never: u64,
    /// Triangles and rays, of all that a ray passes.
    called: u64,
    again: u64,
    most: u32,
    beyond: u64,
}

impl Tally {
    fn add(&mut self, answer: &Answer, asked: usize, is_hit: bool) {
        match answer.nearest.map(|met| met.primitive as usize) {
            Some(number) if number < PAIRS => self.first += 1,
            Some(_) => self.second += 1,
            None => {}
        }
        let is_beyond = answer.called as usize > answer.calls.len();
        self.beyond += u64::from(is_beyond);
        let mut calls: HashMap<u32, u32> = HashMap::new();
        for met in answer.calls {
            *calls.entry(met.primitive).or_default() += 1;
        }
        self.called += calls.len() as u64;
        self.again += calls.values().filter(|&&calls| calls > 1).count() as u64;
        self.most = calls.values().copied().fold(self.most, u32::max);
        let of = |number: usize| answer.calls.iter().find(|met| met.primitive as usize == number);
        match (of(asked), of(asked + PAIRS)) {
            (Some(one), Some(other)) => {
                self.differ += u64::from(one.t.to_bits() != other.t.to_bits())
            }
            _ => self.never += u64::from(is_hit && !is_beyond),
        }
    }
}
