//! The last frame, and whether its light may be used again.

use common::scene::{Camera, Sun};
use glam::{Affine3A, UVec2};

use super::Constants;
use super::moving::Motion;
use super::passes::Tests;
use super::scenes::SceneName;

/// The most frames that a window leaves out and still goes on with its history: a quarter of a second.
const MAX_STEP: u32 = 15;

/// All that decides whether an earlier frame's light may be used. The camera is not part of it, nor is anything that
/// the frame's number moves.
#[derive(Clone, Copy, PartialEq)]
pub struct Valid {
    pub constants: Constants,
    pub name: SceneName,
    pub motion: Motion,
    pub sun: Sun,
    pub light_size: f32,
    pub depth: u32,
    pub seed: u32,
    pub history: bool,
    pub tests: Tests,
    pub size: UVec2,
}

/// A frame, as far as the next one needs to know it.
pub struct Done {
    pub valid: Valid,
    pub camera: Camera,
    /// The transforms of all instances.
    pub places: Vec<Affine3A>,
    /// Its number in the animation.
    pub frame: u32,
    /// Number of frames since the history began.
    pub age: u32,
}

impl Done {
    /// Tests whether the next frame may use what this one knows: nothing but camera and time has changed, and neither
    /// has jumped.
    pub fn goes_on_to(&self, valid: &Valid, camera: &Camera, frame: u32) -> bool {
        self.valid == *valid
            && !camera.is_cut_from(&self.camera)
            && frame.wrapping_sub(self.frame) <= MAX_STEP
    }
}
