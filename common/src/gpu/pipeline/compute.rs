//! A compute pipeline: one shader, and the shape of its workgroups.

use std::ops::Deref;

use ash::vk;
use glam::UVec2;

use super::{Pipeline, PipelineBuilder};

crate::shader_struct! {
    /// The pixels that a dispatch is for, as its shader gets them.
    ///
    /// A dispatch counts from 0, and in whole workgroups: the shader adds where the band begins, and does
    /// nothing where the band has ended. (`vkCmdDispatchBase` counts from elsewhere, but in whole workgroups,
    /// too, and a band begins at any row.)
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
    /// An empty pipeline, to be filled line by line; its shader lies in `shaders/{name}/`.
    pub fn builder(name: &str) -> PipelineBuilder<'_> {
        PipelineBuilder::new(name)
    }

    /// Records as many workgroups as cover `area`, from its first pixel on: the push constants say which
    /// that is, as a [`Band`].
    pub fn dispatch(&self, cmd: vk::CommandBuffer, area: vk::Rect2D) {
        let [across, down] = self.workgroup;
        let vk::Extent2D { width, height } = area.extent;
        // SAFETY: the pipeline and its descriptors are bound and outlive the submission. No picture has so
        // many pixels a side that the workgroups are more than every device takes, 65535.
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
