//! A two-dimensional image: the picture that rays write, a texture, or a rasteriser's attachment.

mod mipmaps;
mod texels;

use anyhow::{Context, Result, ensure};
use ash::vk;
use gpu_allocator::MemoryLocation;

use crate::gpu::memory::Memory;
use crate::gpu::memory::staging::read_back;
use crate::gpu::{Gpu, barrier};
pub use texels::Texels;

/// The only mip level and layer of every colour image here.
const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

/// A copy between such an image and a buffer, without its extent.
pub(in crate::gpu) const COPY: vk::BufferImageCopy = vk::BufferImageCopy {
    buffer_offset: 0,
    buffer_row_length: 0,
    buffer_image_height: 0,
    image_subresource: vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        mip_level: 0,
        base_array_layer: 0,
        layer_count: 1,
    },
    image_offset: vk::Offset3D { x: 0, y: 0, z: 0 },
    image_extent: vk::Extent3D { width: 0, height: 0, depth: 1 },
};

/// A `VkImage`, its memory and a view, freed on drop. Only textures may have more than one mip level.
pub struct Image {
    /// The Vulkan handle.
    pub handle: vk::Image,
    /// A view of the whole image.
    pub view: vk::ImageView,
    /// Width and height in pixels.
    pub extent: vk::Extent2D,
    /// The format.
    pub format: vk::Format,
    levels: u32,
    memory: Option<Memory>,
    gpu: Gpu,
}

impl Image {
    /// An image that shaders write: four linear 32-bit floats per pixel, cleared to zero, `GENERAL`.
    ///
    /// # Errors
    /// If a side is 0 or above the device's limit, or memory is short.
    pub fn storage(gpu: &Gpu, name: &str, extent: vk::Extent2D) -> Result<Self> {
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let image = Self::new(gpu, name, extent, format, format, usage, 1)?;
        gpu.submit(|cmd| {
            let layout = vk::ImageLayout::GENERAL;
            image.transition(cmd, vk::ImageLayout::UNDEFINED, layout);
            let black = vk::ClearColorValue::default();
            // SAFETY: the image is in GENERAL and outlives the submission.
            unsafe {
                gpu.device.cmd_clear_color_image(cmd, image.handle, layout, &black, &[WHOLE]);
            }
            barrier::fill_to_trace(gpu, cmd);
            Ok(())
        })?;
        Ok(image)
    }

    /// An image that a picture is copied to, drawn over, and copied from; its layout is undefined.
    ///
    /// Copies use `format`, drawing uses `view_format`, of the same size: so a picture can be converted to sRGB,
    /// and a panel blended over it in sRGB, where its colours were chosen.
    ///
    /// # Errors
    /// If a side is 0 or above the device's limit, or memory is short.
    pub fn canvas(
        gpu: &Gpu,
        name: &str,
        extent: vk::Extent2D,
        format: vk::Format,
        view_format: vk::Format,
    ) -> Result<Self> {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        Self::new(gpu, name, extent, format, view_format, usage, 1)
    }

    /// An image to draw to, colour or depth depending on its format, with additional `usage`; its layout is undefined.
    ///
    /// # Errors
    /// If a side is 0 or above the device's limit for attachments, or memory is short.
    pub fn attachment(
        gpu: &Gpu,
        name: &str,
        extent: vk::Extent2D,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) -> Result<Self> {
        let limit = gpu.limits.max_attachment_side();
        ensure!(
            extent.width.max(extent.height) <= limit,
            "{}x{} is more than {} can draw to: each side must be at most {limit}",
            extent.width,
            extent.height,
            gpu.name
        );
        let drawn = match aspect(format) {
            vk::ImageAspectFlags::DEPTH => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            _ => vk::ImageUsageFlags::COLOR_ATTACHMENT,
        };
        Self::new(gpu, name, extent, format, format, usage | drawn, 1)
    }

    fn new(
        gpu: &Gpu,
        name: &str,
        extent: vk::Extent2D,
        format: vk::Format,
        view_format: vk::Format,
        usage: vk::ImageUsageFlags,
        levels: u32,
    ) -> Result<Self> {
        let (width, height) = (extent.width, extent.height);
        let limit = gpu.limits.core.max_image_dimension2_d;
        ensure!(
            (1..=limit).contains(&width) && (1..=limit).contains(&height),
            "{width}x{height} is not a size that {} can do: each side must be 1 to {limit}",
            gpu.name
        );
        let mutable = vk::ImageCreateFlags::MUTABLE_FORMAT;
        let flags = if view_format == format { Default::default() } else { mutable };
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent.into())
            .mip_levels(levels)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        let too_large = || format!("no memory for the image '{name}' of {width}x{height}");
        // SAFETY: the device is alive; `image` destroys the handles on every path.
        let handle = unsafe { gpu.device.create_image(&info, None) }.with_context(too_large)?;
        let view = vk::ImageView::null();
        let mut image =
            Self { handle, view, extent, format, levels, memory: None, gpu: gpu.clone() };
        // SAFETY: as above.
        let requirements = unsafe { gpu.device.get_image_memory_requirements(handle) };
        let memory = Memory::new(gpu, name, requirements, MemoryLocation::GpuOnly, false)
            .with_context(too_large)?;
        let info = vk::ImageViewCreateInfo::default()
            .image(handle)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(view_format)
            .components(channels(format))
            .subresource_range(image.range());
        let allocation = &image.memory.insert(memory).allocation;
        // SAFETY: the allocation was made for this image and is freed after it.
        unsafe {
            gpu.device.bind_image_memory(handle, allocation.memory(), allocation.offset())?;
            image.view = gpu.device.create_image_view(&info, None)?;
        }
        gpu.name_object(handle, name);
        gpu.name_object(image.view, name);
        Ok(image)
    }

    /// All mip levels of the single layer, of colour or depth.
    pub fn range(&self) -> vk::ImageSubresourceRange {
        let aspect_mask = aspect(self.format);
        vk::ImageSubresourceRange { aspect_mask, level_count: self.levels, ..WHOLE }
    }

    /// Changes the layout, after all earlier commands and before all later ones.
    pub fn transition(&self, cmd: vk::CommandBuffer, from: vk::ImageLayout, to: vk::ImageLayout) {
        transition(&self.gpu, cmd, self.handle, from, to);
    }

    /// The pixels of a storage image, four floats each, rows from top to bottom.
    ///
    /// # Errors
    /// If the copy fails.
    pub fn read(&self) -> Result<Vec<[f32; 4]>> {
        let bytes = 16 * u64::from(self.extent.width) * u64::from(self.extent.height);
        let mut copy = read_back(&self.gpu, "picture", bytes, |cmd, to| {
            use vk::ImageLayout as Layout;
            let (device, layout) = (&self.gpu.device, Layout::TRANSFER_SRC_OPTIMAL);
            let region = vk::BufferImageCopy { image_extent: self.extent.into(), ..COPY };
            self.transition(cmd, Layout::GENERAL, layout);
            // SAFETY: the image is in the layout named; both outlive the submission.
            unsafe { device.cmd_copy_image_to_buffer(cmd, self.handle, layout, to, &[region]) };
            self.transition(cmd, layout, Layout::GENERAL);
        })?;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(bytes as usize / 16).context("no memory to read the picture")?;
        let copied = copy.mapped_bytes().chunks_exact(16);
        pixels.extend(copied.map(bytemuck::pod_read_unaligned::<[f32; 4]>));
        Ok(pixels)
    }
}

/// Changes the layout of the first level of any image, after all earlier commands and before all later ones.
pub fn transition(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    image: vk::Image,
    from: vk::ImageLayout,
    to: vk::ImageLayout,
) {
    transition_level(gpu, cmd, image, 0, [from, to]);
}

/// As [`transition`], for one mip level.
pub(in crate::gpu) fn transition_level(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    image: vk::Image,
    level: u32,
    [from, to]: [vk::ImageLayout; 2],
) {
    let range = vk::ImageSubresourceRange { base_mip_level: level, ..WHOLE };
    let barriers = [vk::ImageMemoryBarrier2::default()
        .image(image)
        .subresource_range(range)
        .old_layout(from)
        .new_layout(to)
        .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)];
    let dependency = vk::DependencyInfo::default().image_memory_barriers(&barriers);
    // SAFETY: cmd is being recorded on this device.
    unsafe { gpu.device.cmd_pipeline_barrier2(cmd, &dependency) };
}

/// The channels as shaders read them: a texture of two is x and y of a vector whose z is 1.
fn channels(format: vk::Format) -> vk::ComponentMapping {
    let b = match format {
        vk::Format::R16G16_SFLOAT => vk::ComponentSwizzle::ONE,
        _ => vk::ComponentSwizzle::IDENTITY,
    };
    vk::ComponentMapping { b, ..Default::default() }
}

/// The aspect of a format: depth or colour.
fn aspect(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for, so the device no longer uses the image.
        unsafe {
            self.gpu.device.destroy_image_view(self.view, None);
            self.gpu.device.destroy_image(self.handle, None);
        }
    }
}
