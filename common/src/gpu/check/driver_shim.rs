//! A layer between this program and its driver, to emulate another driver: it sees shaders and builds first.

use anyhow::Result;
use glam::Vec3;

use crate::gpu::Gpu;
use crate::gpu::device::requirements::Requirements;
use crate::gpu::pipeline::shader::StageText;

/// Another driver, emulated on top of the actual one: its arithmetic and traversal, within the limits of Vulkan.
///
/// The default methods change nothing.
pub trait DriverShim: Send + Sync {
    /// A name for its arithmetic and traversal, in a word.
    fn name(&self) -> &'static str {
        "driver"
    }

    /// The requirements for the emulation, added to the sample's.
    fn requirements(&self, asked: Requirements) -> Requirements {
        asked
    }

    /// Called with a new device, before anything is created on it.
    ///
    /// # Errors
    /// Any failure of the emulation.
    fn opened(&self, _: &Gpu) -> Result<()> {
        Ok(())
    }

    /// The SPIR-V of a stage, as passed to the driver.
    ///
    /// # Errors
    /// If the text does not compile.
    fn words(&self, stage: &StageText) -> Result<Vec<u32>> {
        stage.words()
    }

    /// True if shaders may require rounding to nearest even, where the device supports it.
    fn rounds_to_nearest_even(&self) -> bool {
        true
    }

    /// The primitives of a build, in the order in which their candidates may be reported.
    fn order(&self, primitives: Vec<u32>) -> Vec<u32> {
        primitives
    }

    /// The triangles of a build, each repeated as often as its any-hit shader may be called.
    fn candidates(&self, triangles: Vec<u32>) -> Vec<u32> {
        triangles
    }

    /// The boxes of a build, as large as traversal may treat them: low and high corners.
    fn boxes(&self, boxes: Vec<[Vec3; 2]>) -> Vec<[Vec3; 2]> {
        boxes
    }
}

/// The actual driver, unchanged.
pub struct Plain;

impl DriverShim for Plain {}
