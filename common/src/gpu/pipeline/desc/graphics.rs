//! The attachments and fixed-function state of a graphics pipeline.

use anyhow::Result;
use ash::{Device, vk};
use serde::{Deserialize, Serialize};

/// The attachments of a graphics pipeline. It draws both sides of triangles to the whole area, with one sample per
/// pixel and no vertex input: its vertex shader reads by address.
#[derive(Clone, Debug, Default, PartialEq, Hash, Serialize, Deserialize)]
pub struct Attachments {
    /// `VkFormat` of each colour attachment.
    pub colors: Vec<i32>,
    /// `VkFormat` of the depth attachment, and the `VkCompareOp` of the depth test.
    pub depth: Option<(i32, i32)>,
}

impl Attachments {
    /// Creates the pipeline from these stages; viewport and scissor are set when it is bound.
    pub(super) fn pipeline(
        &self,
        device: &Device,
        stages: &[vk::PipelineShaderStageCreateInfo],
        layout: vk::PipelineLayout,
        cache: vk::PipelineCache,
        flags: vk::PipelineCreateFlags,
    ) -> Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)> {
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let mut depth = vk::PipelineDepthStencilStateCreateInfo::default();
        let mut formats = vk::PipelineRenderingCreateInfo::default();
        if let Some((format, compare)) = self.depth {
            depth = depth
                .depth_test_enable(true)
                .depth_write_enable(true)
                .depth_compare_op(vk::CompareOp::from_raw(compare));
            formats = formats.depth_attachment_format(vk::Format::from_raw(format));
        }
        let all = vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        let blend: Vec<_> = self.colors.iter().map(|_| all).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blend);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let colors: Vec<_> = self.colors.iter().map(|&raw| vk::Format::from_raw(raw)).collect();
        let mut formats = formats.color_attachment_formats(&colors);
        let info = [vk::GraphicsPipelineCreateInfo::default()
            .flags(flags)
            .stages(stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut formats)];
        // SAFETY: all handles are alive, and so is all that the structures point to.
        unsafe { device.create_graphics_pipelines(cache, &info, None) }
    }
}
