//! The scenes of this chapter, and a view of each.

use common::model::Model;
use common::scene::{Camera, Instance};
use glam::DVec3;

use super::shapes::{Shapes, first_material, grid_side};

common::shader_enum! {
    /// The scenes.
    pub enum SceneKind { Chess, Grid, RandomBall }
}

/// Default number of shapes in a scene.
pub fn default_count(scene: SceneKind) -> u32 {
    match scene {
        SceneKind::RandomBall => 1024,
        _ => 10_000,
    }
}

/// A view that shows a scene.
pub fn camera(scene: SceneKind, chess: Camera, count: u32) -> Camera {
    match scene {
        SceneKind::Chess => chess,
        SceneKind::Grid => {
            let side = f64::from(grid_side(count));
            let (eye, target) = (DVec3::new(0.85, 0.62, 1.2), DVec3::new(0.0, -0.06, 0.0));
            Camera::new(side * eye, side * target, 44.0)
        }
        SceneKind::RandomBall => Camera::new(DVec3::new(0.0, 0.0, 60.0), DVec3::ZERO, 60.0),
    }
}

/// The shapes of a scene: `count` of them, except in *chess*, where they replace pawns and rooks.
///
/// The model has the shapes' materials behind its own. The other scenes have no triangles.
pub fn shapes(scene: SceneKind, count: u32, model: &Model, pieces: &[Instance]) -> Shapes {
    let mut shapes = Shapes::default();
    match scene {
        SceneKind::Chess => shapes.chess(model, pieces),
        SceneKind::Grid => shapes.grid(count, first_material(model)),
        SceneKind::RandomBall => shapes.random_ball(count, first_material(model)),
    }
    shapes
}
