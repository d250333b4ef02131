//! A compute pipeline: one shader, and the shape of its workgroups.

use std::ops::Deref;

use ash::vk;
use glam::UVec2;

use super::{Pipeline, PipelineBuilder};

crate::shader_struct! {
    /// The pixels a dispatch covers, as its shader receives them.
    ///
    /// A dispatch counts from 0 and in whole workgroups, so the shader adds the start of the band and does nothing
    /// beyond its end. (`vkCmdDispatchBase` has an offset, but also in whole workgroups, and a band may begin at
    /// any row.)
    pub struct Band {
        /// The first pixel.
        pub first: UVec2,
        /// Width and height in pixels.
        pub size: UVec2,
    }
}

impl From<vk::Rect2D> for Band {
    fn from(area: vk::Rect2D) -> Self {
        let vk::Rect2D { offset, extent } = area;
        Self {
            first: UVec2::new(offset.x as u32, offset.y as u32),
            size: UVec2::new(extent.width, extent.height),
        }
    }
}

/// A pipeline of one compute shader.
pub struct ComputePipeline {
    /// Width and height of a workgroup, in invocations.
    pub workgroup: [u32; 2],
    pub(super) pipeline: Pipeline,
}

impl ComputePipeline {
    /// An empty pipeline, to be filled line by line; its shader is in `shaders/{name}/`.
    pub fn builder(name: &str) -> PipelineBuilder<'_> {
        PipelineBuilder::new(name)
    }

    /// Records as many workgroups as cover `area`. The push constants contain its first pixel, as a [`Band`].
    pub fn dispatch(&self, cmd: vk::CommandBuffer, area: vk::Rect2D) {
        let [across, down] = self.workgroup;
        let vk::Extent2D { width, height } = area.extent;
        // SAFETY: the pipeline and its descriptors are bound and outlive the submission. No picture has so many
        // pixels per side that it needs more than 65535 workgroups, the guaranteed limit.
        unsafe {
            self.gpu.device.cmd_dispatch(cmd, width.div_ceil(across), height.div_ceil(down), 1);
        }
    }
}

impl Deref for ComputePipeline {
    type Target = Pipeline;

    fn deref(&self) -> &Pipeline {
        &self.pipeline
    }
}
