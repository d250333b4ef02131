//! What is done to an acceleration structure that is there: it is built again in its place, or updated.

use anyhow::{Result, ensure};
use ash::vk;

use super::{AccelerationStructure, Input, flags, ranges, record_builds, scratch_buffer};
use crate::gpu::Buffer;

impl AccelerationStructure {
    /// Builds the structure again in its place, recording into `cmd`: the same primitives, somewhere else.
    ///
    /// Traces and builds recorded before have read it by then, and those recorded after see what is new. What
    /// `input` names must be visible to builds, and it and `scratch` must live until the commands are done.
    ///
    /// # Errors
    /// If `input` has another shape than that of the build, the structure was compacted, or `scratch` is too
    /// small.
    pub fn rebuild(&self, cmd: vk::CommandBuffer, input: Input, scratch: &Buffer) -> Result<()> {
        ensure!(
            self.size >= self.plan.size,
            "'{}' was compacted to {} bytes, and a build takes {}: build another",
            self.plan.name,
            self.size,
            self.plan.size
        );
        self.record(cmd, input, scratch, vk::BuildAccelerationStructureModeKHR::BUILD)
    }

    /// Moves the primitives of a structure that was built `updatable`, recording into `cmd`. Its tree stays;
    /// only the boxes in it follow.
    ///
    /// `input` must have the shape of the build: only positions, boxes and instances may differ, and no index.
    /// An instance may become another's, yet not vanish. Otherwise as [`AccelerationStructure::rebuild`].
    ///
    /// # Errors
    /// If the structure is not updatable, `input` has another shape, or `scratch` is too small.
    pub fn update(&self, cmd: vk::CommandBuffer, input: Input, scratch: &Buffer) -> Result<()> {
        ensure!(
            self.plan.options.updatable,
            "'{}' was not built to be updated: that takes BuildOptions::updatable, ALLOW_UPDATE in Vulkan",
            self.plan.name
        );
        self.record(cmd, input, scratch, vk::BuildAccelerationStructureModeKHR::UPDATE)
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
        input: Input,
        scratch: &Buffer,
        mode: vk::BuildAccelerationStructureModeKHR,
    ) -> Result<()> {
        self.plan.shape.check(&self.plan.name, &input.shape())?;
        let is_update = mode == vk::BuildAccelerationStructureModeKHR::UPDATE;
        let needed = if is_update { self.update_scratch() } else { self.build_scratch() };
        ensure!(
            scratch.size >= needed,
            "'{}' needs {needed} bytes of scratch, and the buffer has {}",
            self.plan.name,
            scratch.size
        );
        let geometries = input.described();
        let info = vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(input.level())
            // The same as those of the build, whatever they were.
            .flags(flags(self.plan.options))
            .mode(mode)
            .geometries(&geometries)
            .dst_acceleration_structure(self.handle)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: scratch.address });
        let source = if is_update { self.handle } else { vk::AccelerationStructureKHR::null() };
        let info = info.src_acceleration_structure(source);
        record_builds(&self.gpu, cmd, &[info], &[&ranges(&input.counts())]);
        Ok(())
    }
}
