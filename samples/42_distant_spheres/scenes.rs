//! The scenes of this chapter, and a view of each.

use common::model::Model;
use common::scene::{Camera, Instance};
use glam::{DVec3, Vec3};

use super::random::unit;
use super::shapes::{Shapes, first_material, grid_side, in_ball};

common::shader_enum! {
    /// The scenes.
    pub enum SceneKind { Chess, Grid, RandomBall, Planet, OneSphere, Dust }
}

/// Radius of the cloud of *dust*, and of its grains.
const DUST_CLOUD: f64 = 0.05;
const DUST_GRAIN: f32 = 1e-4;

/// Default number of shapes in a scene.
pub fn default_count(scene: SceneKind) -> u32 {
    match scene {
        SceneKind::RandomBall => 1024,
        _ => 10_000,
    }
}

/// Returns whether the number of a scene's shapes can be chosen.
pub fn has_count(scene: SceneKind) -> bool {
    matches!(scene, SceneKind::Grid | SceneKind::RandomBall | SceneKind::Dust)
}

/// A view that shows a scene; `distance` is that of *one sphere*, in radii from its surface.
pub fn camera(scene: SceneKind, chess: Camera, count: u32, distance: f32) -> Camera {
    match scene {
        SceneKind::Chess => chess,
        SceneKind::Grid => {
            let side = f64::from(grid_side(count));
            let (eye, target) = (DVec3::new(0.85, 0.62, 1.2), DVec3::new(0.0, -0.06, 0.0));
            Camera::new(side * eye, side * target, 44.0)
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

/// The shapes of a scene: `count` of them where that is free. In *chess* they stand in for pawns and rooks.
///
/// The model has the shapes' materials behind its own. The other scenes have no triangles.
pub fn shapes(scene: SceneKind, count: u32, model: &Model, pieces: &[Instance]) -> Shapes {
    let first = first_material(model);
    let mut shapes = Shapes::default();
    match scene {
        SceneKind::Chess => shapes.chess(model, pieces),
        SceneKind::Grid => shapes.grid(count, first),
        SceneKind::RandomBall => shapes.random_ball(count, first),
        SceneKind::Planet => planet(&mut shapes, first),
        SceneKind::OneSphere => shapes.ball(Vec3::ZERO, 1.0, first),
        SceneKind::Dust => {
            for i in 0..count {
                shapes.ball((in_ball(i) * DUST_CLOUD).as_vec3(), DUST_GRAIN, first + i % 6);
            }
        }
    }
    shapes
}

/// A ball with a radius of a million, seen from 1 above it, and objects on it.
fn planet(shapes: &mut Shapes, first: u32) {
    const RADIUS: f32 = 1e6;
    shapes.ball(Vec3::NEG_Y * RADIUS, RADIUS, first + 5);
    for i in 0..24 {
        let [x, z, size, kind] = unit(i, 0).map(|number| number as f32);
        let size = 0.08 + 0.17 * size;
        let depth = -2.4 - 9.0 * z;
        let foot = Vec3::new((x - 0.5) * -0.9 * depth, 0.0, depth);
        let material = first + i % 5;
        if kind < 0.5 {
            shapes.ball(foot + Vec3::Y * size, size, material);
        } else {
            shapes.block(foot, size, 2.0 * size, material);
        }
    }
}
