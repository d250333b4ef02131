//! Where another driver may be emulated: what this program hands to its driver, before the driver gets it.

use anyhow::Result;
use glam::Vec3;

use crate::gpu::Gpu;
use crate::gpu::device::requirements::Requirements;
use crate::gpu::pipeline::shader::StageText;

/// Another driver, made of the one that is there: as it computes and traverses, within what Vulkan allows.
///
/// Each method by itself leaves things as they are.
pub trait DriverShim: Send + Sync {
    /// Whose arithmetic and traversal it is, in a word.
    fn name(&self) -> &'static str {
        "driver"
    }

    /// What a device must have for it, beyond what the sample asks for.
    fn requirements(&self, asked: Requirements) -> Requirements {
        asked
    }

    /// Sees a device that is opened, before anything is made on it.
    ///
    /// # Errors
    /// Whatever went wrong.
    fn opened(&self, _: &Gpu) -> Result<()> {
        Ok(())
    }

    /// The words of a stage, as the driver gets them.
    ///
    /// # Errors
    /// If the text does not compile.
    fn words(&self, stage: &StageText) -> Result<Vec<u32>> {
        stage.words()
    }

    /// Whether shaders may demand that floats are rounded to nearest even, where the device can.
    fn rounds_to_nearest_even(&self) -> bool {
        true
    }

    /// The primitives of a build in the order in which their candidates may come.
    fn order(&self, primitives: Vec<u32>) -> Vec<u32> {
        primitives
    }

    /// The triangles of a build as often as any-hit shaders may be called for them.
    fn candidates(&self, triangles: Vec<u32>) -> Vec<u32> {
        triangles
    }

    /// The boxes of a build as large as traversal may take them for: low and high corners.
    fn boxes(&self, boxes: Vec<[Vec3; 2]>) -> Vec<[Vec3; 2]> {
        boxes
    }
}

/// The driver that there is.
pub struct Plain;

impl DriverShim for Plain {}
