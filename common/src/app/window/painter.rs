//! Draws the picture and the panel to the window.
//!
//! Both are combined on a canvas. The picture is blitted to it as sRGB, so that the device converts linear floats;
//! the panel is blended over it as plain bytes, because its colours were chosen in sRGB. The canvas is then
//! copied, bit by bit, to the window, whose images may have either format. To images of 10 bits it is blitted,
//! from a copy without sRGB, because the device would convert the bytes back.

use anyhow::{Context as _, Result};
use ash::vk;
use egui::{ClippedPrimitive, TextureId, TexturesDelta};
use egui_ash_renderer::allocator::GpuAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer};

use super::style;
use crate::gpu::{Acquired, Gpu, Image, Swapchain, transition};

/// Draws a picture and a panel to images of one format.
pub struct Painter {
    panel: Renderer<GpuAllocator>,
    canvas: Option<Image>,
    /// The canvas's bytes as plain numbers, if the window's images have more bits.
    plain: Option<Image>,
    deep: bool,
    srgb: vk::Format,
    unorm: vk::Format,
    filter: vk::Filter,
    pool: vk::CommandPool,
    unused: Vec<TextureId>,
    gpu: Gpu,
}

impl Painter {
    /// A painter for the images of a swapchain.
    ///
    /// # Errors
    /// If the device rejects the panel's pipeline.
    pub fn new(gpu: &Gpu, swapchain: &Swapchain) -> Result<Self> {
        let format = DynamicRendering {
            color_attachment_format: swapchain.unorm,
            depth_attachment_format: None,
            stencil_attachment_format: None,
        };
        let panel = Renderer::with_gpu_allocator(
            (*gpu.allocator).clone(),
            gpu.device.clone(),
            RenderMode::DynamicRendering(format),
            Options::default(),
        )
        .context("cannot draw the panel")?;
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(gpu.queue_family);
        // SAFETY: the device is alive; the pool is destroyed on drop.
        let pool = unsafe { gpu.device.create_command_pool(&info, None)? };
        gpu.name_object(pool, "commands of the panel");
        // SAFETY: the physical device belongs to the live instance.
        let picture = unsafe {
            let format = vk::Format::R32G32B32A32_SFLOAT;
            let instance = &gpu.vulkan.instance;
            instance.get_physical_device_format_properties(gpu.physical_device, format)
        };
        let linear = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        let smooth = picture.optimal_tiling_features.contains(linear);
        Ok(Self {
            panel,
            canvas: None,
            plain: None,
            deep: swapchain.deep,
            srgb: swapchain.srgb,
            unorm: swapchain.unorm,
            filter: if smooth { vk::Filter::LINEAR } else { vk::Filter::NEAREST },
            pool,
            unused: Vec::new(),
            gpu: gpu.clone(),
        })
    }

    /// Uploads new textures of the panel; must be called for every drawing, shown or not.
    ///
    /// # Errors
    /// If memory is short.
    pub fn textures(&mut self, mut textures: TexturesDelta) -> Result<()> {
        for id in self.unused.drain(..) {
            self.panel.free_texture(id)?;
        }
        for (id, deltas) in textures.set.drain() {
            for delta in deltas {
                self.panel.set_texture(self.gpu.queue, self.pool, id, &delta)?;
            }
        }
        // The current drawing may still use the freed ones.
        self.unused.extend(textures.free.drain());
        Ok(())
    }

    /// Draws a picture, scaled to its area, at the right of a window of size `extent`, and the panel.
    ///
    /// # Errors
    /// If memory is short or the device fails.
    pub fn paint(
        &mut self,
        extent: vk::Extent2D,
        (picture, area): (&Image, vk::Extent2D),
        (triangles, scale): (&[ClippedPrimitive], f32),
        target: Acquired,
    ) -> Result<()> {
        use vk::ImageLayout as Layout;
        if self.canvas.as_ref().is_none_or(|canvas| canvas.extent != extent) {
            (self.canvas, self.plain) = (None, None);
            let make = |name, format| Image::canvas(&self.gpu, name, extent, format, self.unorm);
            self.canvas = Some(make("canvas", self.srgb)?);
            self.plain = self.deep.then(|| make("plain canvas", self.unorm)).transpose()?;
        }
        let canvas = self.canvas.as_ref().context("the canvas was just made")?;
        let plain = self.plain.as_ref();
        let (gpu, panel, filter) = (&self.gpu, &mut self.panel, self.filter);
        gpu.submit_between(target.before, target.after, |cmd| {
            canvas.transition(cmd, Layout::UNDEFINED, Layout::TRANSFER_DST_OPTIMAL);
            if area != extent {
                clear(gpu, cmd, canvas);
            }
            picture.transition(cmd, Layout::GENERAL, Layout::TRANSFER_SRC_OPTIMAL);
            let filter = if picture.extent == area { vk::Filter::NEAREST } else { filter };
            blit(gpu, cmd, picture, (canvas.handle, extent, area), filter);
            picture.transition(cmd, Layout::TRANSFER_SRC_OPTIMAL, Layout::GENERAL);
            canvas.transition(cmd, Layout::TRANSFER_DST_OPTIMAL, Layout::COLOR_ATTACHMENT_OPTIMAL);
            let attachments = [vk::RenderingAttachmentInfo::default()
                .image_view(canvas.view)
                .image_layout(Layout::COLOR_ATTACHMENT_OPTIMAL)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)];
            let info = vk::RenderingInfo::default()
                .render_area(extent.into())
                .layer_count(1)
                .color_attachments(&attachments);
            // SAFETY: the canvas is in the layout named and outlives the submission, as does the panel.
            unsafe { gpu.device.cmd_begin_rendering(cmd, &info) };
            let drawn = panel.cmd_draw(cmd, extent, scale, triangles);
            // SAFETY: rendering was begun above.
            unsafe { gpu.device.cmd_end_rendering(cmd) };
            drawn.context("cannot draw the panel")?;
            canvas.transition(cmd, Layout::COLOR_ATTACHMENT_OPTIMAL, Layout::TRANSFER_SRC_OPTIMAL);
            transition(gpu, cmd, target.image, Layout::UNDEFINED, Layout::TRANSFER_DST_OPTIMAL);
            match plain {
                None => copy(gpu, cmd, canvas, target.image),
                Some(plain) => {
                    plain.transition(cmd, Layout::UNDEFINED, Layout::TRANSFER_DST_OPTIMAL);
                    copy(gpu, cmd, canvas, plain.handle);
                    plain.transition(
                        cmd,
                        Layout::TRANSFER_DST_OPTIMAL,
                        Layout::TRANSFER_SRC_OPTIMAL,
                    );
                    blit(gpu, cmd, plain, (target.image, extent, extent), vk::Filter::NEAREST);
                }
            }
            let shown = Layout::PRESENT_SRC_KHR;
            transition(gpu, cmd, target.image, Layout::TRANSFER_DST_OPTIMAL, shown);
            Ok(())
        })
    }
}

/// The only layer of every image here.
const LAYER: vk::ImageSubresourceLayers = vk::ImageSubresourceLayers {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    mip_level: 0,
    base_array_layer: 0,
    layer_count: 1,
};

/// Fills the canvas with the background of the panel, ready for blits.
fn clear(gpu: &Gpu, cmd: vk::CommandBuffer, canvas: &Image) {
    let color = vk::ClearColorValue { float32: style::BEHIND };
    let ranges = [vk::ImageSubresourceRange::default()
        .aspect_mask(vk::ImageAspectFlags::COLOR)
        .level_count(1)
        .layer_count(1)];
    let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    let written = [vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::CLEAR)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::BLIT)
        .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)];
    let before_the_blit = vk::DependencyInfo::default().memory_barriers(&written);
    // SAFETY: the canvas is in the layout named and outlives the submission.
    unsafe {
        gpu.device.cmd_clear_color_image(cmd, canvas.handle, layout, &color, &ranges);
        gpu.device.cmd_pipeline_barrier2(cmd, &before_the_blit);
    }
}

/// Copies an image to one of the same size, bit by bit.
fn copy(gpu: &Gpu, cmd: vk::CommandBuffer, from: &Image, to: vk::Image) {
    let region = vk::ImageCopy::default()
        .src_subresource(LAYER)
        .dst_subresource(LAYER)
        .extent(from.extent.into());
    let [source, target] =
        [vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL];
    // SAFETY: both images are in the layouts named, as large as the region, and outlive the submission.
    unsafe { gpu.device.cmd_copy_image(cmd, from.handle, source, to, target, &[region]) };
}

/// Scales a picture to the right end of another of the same height: its handle, its size, and the covered area.
fn blit(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    from: &Image,
    (to, size, area): (vk::Image, vk::Extent2D, vk::Extent2D),
    filter: vk::Filter,
) {
    let corner = |x: u32, y: u32, z| vk::Offset3D { x: x as i32, y: y as i32, z };
    let vk::Extent2D { width, height } = from.extent;
    let left = size.width - area.width;
    let regions = [vk::ImageBlit2::default()
        .src_subresource(LAYER)
        .src_offsets([corner(0, 0, 0), corner(width, height, 1)])
        .dst_subresource(LAYER)
        .dst_offsets([corner(left, 0, 0), corner(size.width, size.height, 1)])];
    let info = vk::BlitImageInfo2::default()
        .src_image(from.handle)
        .src_image_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL)
        .dst_image(to)
        .dst_image_layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL)
        .regions(&regions)
        .filter(filter);
    // SAFETY: both images are in the layouts named and outlive the submission.
    unsafe { gpu.device.cmd_blit_image2(cmd, &info) };
}

impl Drop for Painter {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe { self.gpu.device.destroy_command_pool(self.pool, None) };
    }
}
