//! Seeded random rays by the thousand, each family hard in its own way, with the true answers.

mod algebraic;
mod curved;
mod departures;
mod flat;
mod grid;
mod ruled;
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

/// The number of rays of each family, and the seed that they are drawn from.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    pub rays: usize,
    /// 0 draws the rays of all stored figures.
    pub seed: u64,
}

impl Draw {
    /// Random numbers of one purpose: others for each seed, and for each `number`.
    fn random(self, number: u64) -> Random {
        // An odd factor spreads neighbouring seeds over all bits.
        Random(number ^ self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }
}

/// Rays at shapes of one primitive.
pub struct Family {
    pub name: &'static str,
    pub shapes: Vec<Shape>,
    /// Pairs of a shape's index and a ray.
    pub rays: Vec<(usize, Ray)>,
    pub expected: Vec<Expected>,
    /// True if each shape can be part of an acceleration structure: not if there is one per ray.
    pub is_traced: bool,
}

/// A family's generator: given a source of random numbers, it makes a shape and a ray.
pub type Make<'a> = dyn FnMut(&mut Random, usize) -> (usize, DVec3, DVec3) + 'a;

impl Family {
    /// Every family of a primitive. The first is the rung's home ground, the one
    /// that is timed.
    pub fn of(primitive: Primitive, draw: Draw) -> Vec<Self> {
        match primitive {
            Primitive::Sphere => smooth::spheres(draw),
            Primitive::Box => flat::boxes(draw),
            Primitive::Plane => flat::planes(draw),
            Primitive::Triangle => flat::triangles(draw),
            Primitive::Capsule => smooth::capsules(draw),
            Primitive::Instance => smooth::instances(draw),
            Primitive::Heightfield => smooth::heightfields(draw),
            Primitive::SecondaryOrigin => departures::departures(draw),
            Primitive::Accumulation => sums(),
            Primitive::Cone => curved::cones(draw),
            Primitive::Quadric => curved::quadrics(draw),
            Primitive::Patch => ruled::patches(draw),
            Primitive::Voxel => grid::voxels(draw),
            Primitive::Algebraic => algebraic::surfaces(draw),
        }
    }

    /// `make` says which shape, where a ray begins and where it goes, all in f64.
    pub fn new(name: &'static str, shapes: Vec<Shape>, draw: Draw, make: &mut Make) -> Self {
        // Each family has its own numbers, whatever other families there are.
        let seed = name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut random = draw.random(seed);
        let truth = Truth::new(&shapes);
        let (mut rays, mut expected) = (Vec::new(), Vec::new());
        for number in 0..draw.rays {
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
    let one = Draw { rays: 1, seed: 0 };
    let family = |name, value: f32, pattern| {
        let shape = Shape::Sum(Sum { value, n: 1 << 20, pattern });
        let mut family =
            Family::new(name, vec![shape], one, &mut |_, _| (0, DVec3::ZERO, DVec3::Y));
        family.is_traced = false;
        family
    };
    vec![
        family("a million times 0.1", 0.1, Pattern::Constant),
        family("a firefly in ten thousand", 0.1, Pattern::Firefly { spike: 1e4, every: 10_000 }),
        family("after one of 2^24", 1.0, Pattern::Head(16_777_216.0)),
    ]
}
