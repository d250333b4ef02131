//! Spheres and boxes: arrangements of them, and their colours.

use common::gpu::order::Bounds;
use common::gpu::sphere_bounds;
use common::model::Model;
use common::scene::{Instance, Material};
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

/// The shapes beside the triangles.
#[derive(Default)]
pub struct Shapes {
    pub spheres: Vec<Sphere>,
    pub boxes: Vec<Box>,
}

/// Cells along each side of the least cube that holds `count` cells.
pub fn grid_side(count: u32) -> u32 {
    (1..).find(|side: &u32| side.pow(3) >= count).expect("a million is the cube of a hundred")
}

impl Shapes {
    /// Adds a sphere.
    pub fn ball(&mut self, center: Vec3, radius: f32, material: u32) {
        self.spheres.push(Sphere { center, radius, material });
    }

    /// Adds a box on a point, `half` wide to each side.
    pub fn block(&mut self, foot: Vec3, half: f32, height: f32, material: u32) {
        let side = Vec3::new(half, 0.0, half);
        let (low, high) = (foot - side, foot + side + Vec3::Y * height);
        self.boxes.push(Box { low, high, material });
    }

    /// Pawns become balls on plinths and rooks become towers, after Josef Hartwig's set of 1923.
    pub fn chess(&mut self, model: &Model, pieces: &[Instance]) {
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

    /// Adds spheres and boxes by turns, a unit apart, the lowest layer first.
    pub fn grid(&mut self, count: u32, first: u32) {
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

    /// Adds spheres at random places in a ball. Together they fill the same part of it, however many they are.
    pub fn random_ball(&mut self, count: u32, first: u32) {
        let scale = (1024.0 / f64::from(count)).cbrt() as f32;
        for i in 0..count {
            let center = (in_ball(i) * 25.0).as_vec3();
            self.ball(center, (1.0 + unit(i, 64)[0] as f32) * scale, first + i % 6);
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

/// Number of the shapes' first material in a model to which [`materials`] were added.
pub fn first_material(model: &Model) -> u32 {
    (model.materials.len() - MATERIALS.len()) as u32
}

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

/// A random point, uniform in the unit ball: the first in a cube that falls into it.
pub fn in_ball(shape: u32) -> DVec3 {
    let points = (0..).map(|attempt| {
        let [x, y, z, _] = unit(shape, attempt).map(|number| 2.0 * number - 1.0);
        DVec3::new(x, y, z)
    });
    points.into_iter().find(|point| point.length_squared() <= 1.0).expect("most points do")
}
