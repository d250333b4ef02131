//! The last frame, as far as the next one needs to know it.

use common::scene::Camera;
use glam::UVec2;

use super::passes::{Reuse, Weights};
use super::scenes::SceneName;
use super::{Demo, Push};

/// All that decides whether the last frame's reservoirs may be used. The camera is not part of it.
#[derive(Clone, Copy, PartialEq)]
pub struct Valid {
    weights: Weights,
    visibility: bool,
    name: SceneName,
    reuse: Reuse,
    candidates: u32,
    seed: u32,
    size: UVec2,
}

impl Valid {
    /// For a frame with these controls.
    pub fn of(demo: &Demo) -> Self {
        Self {
            weights: demo.constants.weights,
            visibility: demo.constants.visibility,
            name: demo.name,
            reuse: demo.reuse,
            candidates: demo.candidates,
            seed: demo.seed,
            size: demo.pixels.size,
        }
    }
}

/// A frame.
pub struct Done {
    /// The settings that the next frame must share.
    pub valid: Valid,
    /// Its camera, and its push constants.
    pub camera: Camera,
    pub push: Push,
    /// Number of frames since the history began.
    pub age: u32,
    /// True if all its pipelines belong to the same controls: in a window, one may still be the old one.
    pub is_whole: bool,
}

impl Done {
    /// Tests whether a frame may use this one's reservoirs: it has the same settings, and its camera has not jumped.
    pub fn goes_on_to(&self, valid: &Valid, camera: &Camera) -> bool {
        self.valid == *valid && !camera.is_cut_from(&self.camera)
    }
}
