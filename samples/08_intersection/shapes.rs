//! The scenes of this chapter: spheres and boxes, and where they are.

use common::gpu::order::Bounds;
use common::gpu::sphere_bounds;
use common::model::Model;
use common::scene::{Camera, Instance, Material};
use glam::{DVec3, Vec3};

use super::random::unit;

common::shader_struct! {
    /// A sphere.
    pub struct Sphere {
        pub center: Vec3,
        pub radius: f32,
        pub material: u32,
    }
}

common::shader_struct! {
    /// A box with sides along the axes.
    pub struct Box {
        pub low: Vec3,
        pub high: Vec3,
        pub material: u32,
    }
}

impl Sphere {
    /// Corners of the box around it, never inside it by rounding.
    pub fn bounds(&self) -> Bounds {
        sphere_bounds(self.center, self.radius)
    }
}

common::shader_enum! {
    /// The scenes.
    pub enum SceneKind { Chess, Grid, RandomBall, Planet, OneSphere, Dust }
}

/// The shapes beside the triangles.
#[derive(Default)]
pub struct Shapes {
    pub spheres: Vec<Sphere>,
    pub boxes: Vec<Box>,
}

/// Default number of primitives in a scene; 0 where it is fixed.
pub fn default_count(scene: SceneKind) -> u32 {
    match scene {
        SceneKind::RandomBall => 1024,
        _ => 10_000,
    }
}

/// A view that shows a scene; `distance` is that of *one sphere*, in radii from its surface.
pub fn camera(scene: SceneKind, chess: Camera, count: u32, distance: f32) -> Camera {
    match scene {
        SceneKind::Chess => chess,
        SceneKind::Grid => {
            let side = f64::from(grid_side(count));
            Camera::new(
                DVec3::new(0.85, 0.62, 1.2) * side,
                DVec3::new(0.0, -0.06, 0.0) * side,
                44.0,
            )
        }
        SceneKind::RandomBall => Camera::new(DVec3::new(0.0, 0.0, 60.0), DVec3::ZERO, 60.0),
        SceneKind::Planet => Camera::new(DVec3::Y, DVec3::new(0.0, 0.55, -3.0), 40.0),
        SceneKind::OneSphere => {
            let distance = 1.0 + f64::from(distance);
            let eye = DVec3::new(2.0, 1.4, 3.0).normalize() * distance;
            // A tenth more than the sphere fills.
            Camera::new(eye, DVec3::ZERO, (2.2 * (1.0 / distance).asin()).to_degrees())
        }
        SceneKind::Dust => {
            let eye = DVec3::new(2.0, 1.4, 3.0).normalize() * 1e4;
            Camera::new(eye, DVec3::ZERO, (2.0 * DUST_CLOUD / 1e4).to_degrees())
        }
    }
}

/// Radius of the cloud of *dust*, and of its grains.
const DUST_CLOUD: f64 = 0.05;
const DUST_GRAIN: f32 = 1e-4;

/// The least cube that holds `count` cells.
fn grid_side(count: u32) -> u32 {
    (1..).find(|side: &u32| side.pow(3) >= count).expect("a million is the cube of a hundred")
}

impl Shapes {
    /// The shapes of a scene, at most `count` where that is free. For *chess* they stand in for
    /// pawns and rooks; the other scenes have no triangles. Materials are those of [`materials`],
    /// which follow the model's.
    pub fn new(scene: SceneKind, count: u32, model: &Model, pieces: &[Instance]) -> Self {
        let first = (model.materials.len() - MATERIALS.len()) as u32;
        let mut shapes = Self::default();
        match scene {
            SceneKind::Chess => shapes.replace(model, pieces),
            SceneKind::Grid => shapes.grid(count, first),
            SceneKind::RandomBall => {
                // As many as there are, they fill the same part of the ball.
                let scale = (1024.0 / f64::from(count)).cbrt() as f32;
                for i in 0..count {
                    let center = (in_ball(i) * 25.0).as_vec3();
                    let radius = (1.0 + unit(i, 64)[0] as f32) * scale;
                    shapes.spheres.push(Sphere { center, radius, material: first + i % 6 });
                }
            }
            SceneKind::Planet => shapes.planet(first),
            SceneKind::OneSphere => {
                shapes.spheres.push(Sphere { center: Vec3::ZERO, radius: 1.0, material: first });
            }
            SceneKind::Dust => shapes.spheres.extend((0..count).map(|i| Sphere {
                center: (in_ball(i) * DUST_CLOUD).as_vec3(),
                radius: DUST_GRAIN,
                material: first + i % 6,
            })),
        }
        shapes
    }

    fn ball(&mut self, center: Vec3, radius: f32, material: u32) {
        self.spheres.push(Sphere { center, radius, material });
    }

    /// A box that stands on a point, `half` wide to each side.
    fn block(&mut self, foot: Vec3, half: f32, height: f32, material: u32) {
        let side = Vec3::new(half, 0.0, half);
        let (low, high) = (foot - side, foot + side + Vec3::Y * height);
        self.boxes.push(Box { low, high, material });
    }

    /// Pawns become balls on plinths, rooks become towers: geometry for geometry's sake, as in
    /// Josef Hartwig's set of 1923.
    fn replace(&mut self, model: &Model, pieces: &[Instance]) {
        for piece in pieces {
            let at: Vec3 = piece.transform.translation.into();
            let up = |height: f32| at + Vec3::Y * height;
            let material = piece.material as u32;
            match model.meshes[piece.mesh].name.as_str() {
                "pawn" => {
                    self.block(at, 0.27, 0.15, material);
                    self.ball(up(0.39), 0.24, material);
                }
                "rook" => {
                    self.block(at, 0.32, 0.13, material);
                    self.block(up(0.13), 0.22, 0.6, material);
                    self.block(up(0.73), 0.29, 0.13, material);
                    for corner in 0..4 {
                        let side = |bit| if corner & bit == 0 { -0.19 } else { 0.19 };
                        let foot = up(0.86) + Vec3::new(side(1), 0.0, side(2));
                        self.block(foot, 0.1, 0.14, material);
                    }
                }
                _ => {}
            }
        }
    }

    /// Spheres and boxes by turns, a unit apart, the lowest layer first.
    fn grid(&mut self, count: u32, first: u32) {
        let side = grid_side(count);
        for i in 0..count {
            let place = [i % side, i / side / side, i / side % side];
            let middle = (side - 1) as f32 / 2.0;
            let center = Vec3::from_array(place.map(|p| p as f32 - middle));
            let material = first + (unit(i, 0)[0] * 6.0) as u32;
            if place.iter().sum::<u32>() % 2 == 0 {
                self.ball(center, 0.375, material);
            } else {
                // 9/32, so that the walls are numbers that a camera can stand on.
                let half = Vec3::splat(0.28125);
                self.boxes.push(Box { low: center - half, high: center + half, material });
            }
        }
    }

    /// A ball of a million units' radius, seen from 1 above it, and things that stand there.
    fn planet(&mut self, first: u32) {
        const RADIUS: f32 = 1e6;
        self.ball(Vec3::NEG_Y * RADIUS, RADIUS, first + 5);
        for i in 0..24 {
            let [x, z, size, kind] = unit(i, 0).map(|number| number as f32);
            let size = 0.08 + 0.17 * size;
            let depth = -2.4 - 9.0 * z;
            let foot = Vec3::new((x - 0.5) * -0.9 * depth, 0.0, depth);
            let material = first + i % 5;
            if kind < 0.5 {
                self.ball(foot + Vec3::Y * size, size, material);
            } else {
                self.block(foot, size, 2.0 * size, material);
            }
        }
    }
}

/// Tests whether *chess* replaces a piece with shapes.
pub fn is_replaced(model: &Model, piece: &Instance) -> bool {
    ["pawn", "rook"].contains(&model.meshes[piece.mesh].name.as_str())
}

/// Colours of the shapes: red, ochre, green, blue, violet, and pale ground.
const MATERIALS: [[f32; 3]; 6] = [
    [0.55, 0.06, 0.035],
    [0.75, 0.36, 0.05],
    [0.10, 0.30, 0.12],
    [0.04, 0.13, 0.42],
    [0.26, 0.09, 0.30],
    [0.66, 0.60, 0.50],
];

/// The shapes' materials, to be added to a model's.
pub fn materials() -> impl Iterator<Item = Material> {
    MATERIALS.into_iter().map(|color| Material {
        name: "shape".to_owned(),
        base_color: Vec3::from_array(color),
        specular: Vec3::splat(0.04),
        shininess: 120.0,
        ..Material::default()
    })
}

/// A point that is uniform in the unit ball: the first in a cube that falls into it.
fn in_ball(shape: u32) -> DVec3 {
    let points = (0..).map(|attempt| {
        let [x, y, z, _] = unit(shape, attempt).map(|number| 2.0 * number - 1.0);
        DVec3::new(x, y, z)
    });
    points.into_iter().find(|point| point.length_squared() <= 1.0).expect("most points do")
}
