//! Seeded random rays by the thousand, each family hard in its own way, with the true answers.

mod departures;
mod flat;
mod smooth;
mod truth;

use std::f64::consts::TAU;

use glam::DVec3;
use reference::random::{Random, f32s};

use crate::judge::Expected;
use crate::ladder::Primitive;
use crate::query::Ray;
use crate::shape::{Pattern, Shape, Sum};
use truth::Truth;

/// Rays at shapes of one primitive.
pub struct Family {
    pub name: &'static str,
    pub shapes: Vec<Shape>,
    /// Pairs of a shape's index and a ray.
    pub rays: Vec<(usize, Ray)>,
    pub expected: Vec<Expected>,
    /// True if each shape can stand in an acceleration structure: not if there is one per ray.
    pub is_traced: bool,
}

/// A family's generator: given a source of random numbers, it makes a shape and a ray.
pub type Make<'a> = dyn FnMut(&mut Random, usize) -> (usize, DVec3, DVec3) + 'a;

impl Family {
    /// Every family of a primitive, `rays` rays each. The first is the rung's home ground, the one
    /// that is timed.
    pub fn of(primitive: Primitive, rays: usize) -> Vec<Self> {
        match primitive {
            Primitive::Sphere => smooth::spheres(rays),
            Primitive::Box => flat::boxes(rays),
            Primitive::Plane => flat::planes(rays),
            Primitive::Triangle => flat::triangles(rays),
            Primitive::Capsule => smooth::capsules(rays),
            Primitive::Instance => smooth::instances(rays),
            Primitive::Heightfield => smooth::heightfields(rays),
            Primitive::SecondaryOrigin => departures::departures(rays),
            Primitive::Accumulation => sums(),
        }
    }

    /// `make` says which shape, where a ray begins and where it goes, all in f64.
    pub fn new(name: &'static str, shapes: Vec<Shape>, count: usize, make: &mut Make) -> Self {
        // Each family has its own numbers, whatever other families there are.
        let seed = name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut random = Random(seed);
        let truth = Truth::new(&shapes);
        let (mut rays, mut expected) = (Vec::new(), Vec::new());
        for number in 0..count {
            let (shape, origin, direction) = make(&mut random, number);
            let (origin, direction) = (origin.as_vec3(), direction.as_vec3());
            let ray = Ray { origin, direction, tmin: 0.0, tmax: 1e30 };
            expected.push(truth.of(shape, &ray));
            rays.push((shape, ray));
        }
        Self { name, shapes, rays, expected, is_traced: true }
    }
}

/// A point of the disc of this radius around `center`, across `axis`.
fn on_disc(random: &mut Random, center: DVec3, axis: DVec3, radius: f64) -> DVec3 {
    let u = axis.any_orthonormal_vector();
    let v = axis.cross(u);
    let (r, angle) = (random.between(0.0, 1.0).sqrt() * radius, random.between(0.0, TAU));
    center + r * (angle.cos() * u + angle.sin() * v)
}

/// From `distance` away, at a disc a little larger than the unit sphere.
fn from_afar(random: &mut Random, distance: f64) -> (DVec3, DVec3) {
    let axis = random.unit();
    let origin = f32s(axis * distance);
    (origin, (on_disc(random, DVec3::ZERO, axis, 1.1) - origin).normalize())
}

fn sums() -> Vec<Family> {
    let family = |name, value: f32, pattern| {
        let shape = Shape::Sum(Sum { value, n: 1 << 20, pattern });
        let mut family = Family::new(name, vec![shape], 1, &mut |_, _| (0, DVec3::ZERO, DVec3::Y));
        family.is_traced = false;
        family
    };
    vec![
        family("a million times 0.1", 0.1, Pattern::Constant),
        family("a firefly in ten thousand", 0.1, Pattern::Firefly { spike: 1e4, every: 10_000 }),
        family("after one of 2^24", 1.0, Pattern::Head(16_777_216.0)),
    ]
}
