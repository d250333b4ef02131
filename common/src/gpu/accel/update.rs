//! Changes to an existing acceleration structure: rebuilding it in its place, or updating it.

use anyhow::{Result, ensure};
use ash::vk;

use super::AccelerationStructure;
use super::build::{Build, record, scratch_buffer};
use super::input;
use crate::gpu::{Buffer, Geometry};

impl AccelerationStructure {
    /// Rebuilds the structure in its place, recording into `cmd`: the same primitives at other positions.
    ///
    /// Includes barriers: earlier traces and builds finish reading first, and later ones see the result. The
    /// buffers in `geometries` must be visible to builds, and they and `scratch` must live until the commands are
    /// done.
    ///
    /// # Errors
    /// If `geometries` differ in kind or number from those of the build, the structure was compacted, or `scratch`
    /// is too small.
    pub fn rebuild(
        &self,
        cmd: vk::CommandBuffer,
        geometries: &[Geometry],
        scratch: &Buffer,
    ) -> Result<()> {
        let needed = self.plan.sizes.acceleration_structure_size;
        ensure!(
            self.size >= needed,
            "'{}' was compacted to {} bytes, and a build takes {needed}: build another",
            self.plan.name,
            self.size
        );
        self.record(cmd, geometries, scratch, vk::BuildAccelerationStructureModeKHR::BUILD)
    }

    /// Moves the primitives of a structure that was built `updatable`, recording into `cmd`. Its tree stays the
    /// same; only the boxes in it follow.
    ///
    /// `geometries` must be those of the build: only positions, boxes and instances may differ, but not the
    /// indices. An instance may refer to another bottom level, but must not become inactive. Otherwise as
    /// [`AccelerationStructure::rebuild`].
    ///
    /// # Errors
    /// If the structure is not updatable, `geometries` differ in kind or number, or `scratch` is too small.
    pub fn update(
        &self,
        cmd: vk::CommandBuffer,
        geometries: &[Geometry],
        scratch: &Buffer,
    ) -> Result<()> {
        ensure!(
            self.plan.options.updatable,
            "'{}' was not built to be updated: that takes BuildOptions::updatable, ALLOW_UPDATE in Vulkan",
            self.plan.name
        );
        self.record(cmd, geometries, scratch, vk::BuildAccelerationStructureModeKHR::UPDATE)
    }

    /// A scratch buffer for builds and updates of this structure, one after the other.
    ///
    /// # Errors
    /// If memory is short.
    pub fn scratch(&self) -> Result<Buffer> {
        scratch_buffer(&self.gpu, self.build_scratch().max(self.update_scratch()))
    }

    fn record(
        &self,
        cmd: vk::CommandBuffer,
        geometries: &[Geometry],
        scratch: &Buffer,
        mode: vk::BuildAccelerationStructureModeKHR,
    ) -> Result<()> {
        self.plan.check(geometries)?;
        input::check_arrays(&self.gpu, &self.plan.name, geometries)?;
        let is_update = mode == vk::BuildAccelerationStructureModeKHR::UPDATE;
        let needed = if is_update { self.update_scratch() } else { self.build_scratch() };
        ensure!(
            scratch.size >= needed,
            "'{}' needs {needed} bytes of scratch, and the buffer has {}",
            self.plan.name,
            scratch.size
        );
        let build = Build { structure: self, geometries, scratch: scratch.address };
        record(&self.gpu, cmd, mode, &[build]);
        Ok(())
    }
}
