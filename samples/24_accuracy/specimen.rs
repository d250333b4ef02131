//! Specimens in the window: one shape of each kind, and a camera that has it in view.

use common::scene::Camera;
use glam::{DVec3, Vec3};

use crate::ladder::Primitive;
use crate::shape::{Algebraic, Cone, Heightfield, Leaving, Shape, Voxel};

/// Primitives that can be looked at; a sum cannot.
pub const PRIMITIVES: [Primitive; 13] = [
    Primitive::Sphere,
    Primitive::Box,
    Primitive::Plane,
    Primitive::Triangle,
    Primitive::Capsule,
    Primitive::Instance,
    Primitive::Heightfield,
    Primitive::SecondaryOrigin,
    Primitive::Cone,
    Primitive::Quadric,
    Primitive::Patch,
    Primitive::Voxel,
    Primitive::Algebraic,
];

/// Towards the sun.
pub const SUN: Vec3 = Vec3::new(0.5, 0.7, 0.6);

/// The normal of the plane; of no simple length, so that its numbers have to be rounded.
const TILTED: Vec3 = Vec3::new(1.0, 2.0, 0.6);

/// One shape, and how hard it is made to hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specimen {
    /// Position in [`PRIMITIVES`].
    pub primitive: u32,
    /// The distance of the camera from the shape, in radii; of plane and instance from the world's origin.
    pub distance: f32,
}

impl Specimen {
    pub fn primitive(&self) -> Primitive {
        PRIMITIVES[self.primitive as usize]
    }

    pub fn shape(&self) -> Shape {
        match self.primitive() {
            Primitive::Sphere | Primitive::Accumulation => {
                Shape::Sphere { center: Vec3::ZERO, radius: 1.0 }
            }
            Primitive::Box => {
                Shape::Box { low: Vec3::new(-0.75, -0.5, -0.5), high: Vec3::new(0.75, 0.5, 0.5) }
            }
            Primitive::Plane => Shape::Plane { normal: TILTED, distance: self.distance },
            Primitive::Triangle => Shape::Triangles(octahedron()),
            Primitive::Capsule => {
                let end = Vec3::new(0.5, 0.35, 0.2);
                Shape::Capsule { a: -end, b: end, radius: 0.45 }
            }
            Primitive::Instance => {
                let x = self.distance;
                Shape::Instance([[0.9, 0.3, 0.0, x], [-0.2, 0.5, 0.1, 0.0], [0.1, 0.0, -0.8, -x]])
            }
            Primitive::Heightfield => Shape::Heightfield(Heightfield {
                k: 1.0,
                a: 0.6,
                f: [0.11, 0.08],
                b: 0.25,
                g: [0.3, 0.2],
                lipschitz: 1.373_695_8,
            }),
            Primitive::Cone => Shape::Cone(Cone {
                a: Vec3::new(-0.5, -0.5, -0.25),
                b: Vec3::new(0.5, 0.5, 0.25),
                radii: [0.5, 0.25],
                is_closed: true,
            }),
            // One sheet, as of a cooling tower, leaning.
            Primitive::Quadric => {
                Shape::Quadric([4.0, -1.0, 4.0, 0.0, 0.0, 1.0, 0.0, 0.25, 0.0, -1.0])
            }
            // So steep that a part of it is hidden behind its own fold.
            Primitive::Patch => Shape::Patch([
                Vec3::new(-0.625, -0.5, 0.75),
                Vec3::new(0.75, -0.625, -0.75),
                Vec3::new(-0.5, 0.625, -0.875),
                Vec3::new(0.5, 0.5, 0.75),
            ]),
            // Two sheets, and a tunnel from one to the other.
            Primitive::Voxel => Shape::Voxel(Voxel {
                low: Vec3::splat(-0.7),
                high: Vec3::splat(0.7),
                corners: [0.6, -0.1, -0.2, 0.05, 0.1, -0.15, -0.3, 0.7],
            }),
            Primitive::Algebraic => Shape::Algebraic(kummer()),
            Primitive::SecondaryOrigin => Shape::Leaving(Leaving {
                center: Vec3::ZERO,
                radius: 1.0,
                direction: SUN.normalize(),
                gap: None,
            }),
        }
    }

    pub fn camera(&self) -> Camera {
        let from = DVec3::new(0.35, 0.45, 0.82).normalize();
        let distance = f64::from(self.distance);
        match self.primitive() {
            Primitive::Plane => {
                let up = TILTED.as_dvec3().normalize();
                let (eye, ahead) = (up * (distance + 1.5), up.any_orthonormal_vector());
                Camera { up, ..Camera::new(eye, eye + ahead - 0.35 * up, 50.0) }
            }
            Primitive::Heightfield => {
                let eye = DVec3::new(0.0, 1.6, 0.0);
                Camera::new(eye, eye + DVec3::new(0.3, -0.2, -1.0), 50.0)
            }
            Primitive::Instance => {
                let center = DVec3::new(distance, 0.0, -distance);
                Camera::new(center + 4.0 * from, center, 36.0)
            }
            // As near or as far as it is, it fills the picture.
            _ => {
                let angle = (1.25 / distance).min(0.9).asin().to_degrees();
                Camera::new(from * distance, DVec3::ZERO, 2.0 * angle)
            }
        }
    }
}

/// A Kummer surface within a box. Its sixteen nodes, where it is pointed like a cone, are (1, 1, 1), the permutations of
/// (1/2, 1/2, 1/4), and all of these with two signs changed.
pub fn kummer() -> Algebraic {
    Algebraic::from_terms(
        1.25,
        &[
            ([4, 0, 0], 16.0),
            ([0, 4, 0], 16.0),
            ([0, 0, 4], 16.0),
            ([2, 2, 0], -20.0),
            ([0, 2, 2], -20.0),
            ([2, 0, 2], -20.0),
            ([1, 1, 1], 26.0),
            ([2, 0, 0], -5.0),
            ([0, 2, 0], -5.0),
            ([0, 0, 2], -5.0),
            ([0, 0, 0], 1.0),
        ],
    )
}

fn octahedron() -> Vec<[Vec3; 3]> {
    let mut triangles = Vec::new();
    for x in [Vec3::NEG_X, Vec3::X] {
        for y in [Vec3::NEG_Y, Vec3::Y] {
            for z in [Vec3::NEG_Z, Vec3::Z] {
                triangles.push([x, y, z]);
            }
        }
    }
    triangles
}
