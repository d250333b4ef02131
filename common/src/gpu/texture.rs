//! The texture table: every texture of a scene in one array, which any shader indexes by number.

use anyhow::Result;
use ash::vk;

use super::{Gpu, Image};

/// Set 1 of every pipeline that reads textures: binding 0, an array of combined image samplers.
pub struct TextureTable {
    /// The layout of the set.
    pub layout: vk::DescriptorSetLayout,
    /// The set.
    pub set: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    sampler: vk::Sampler,
    _images: Vec<Image>,
    gpu: Gpu,
}

impl TextureTable {
    /// A table of `images`, numbered by position, repeated beyond their edges and filtered linearly.
    ///
    /// # Errors
    /// If the device has no room for so many.
    pub fn new(gpu: &Gpu, images: Vec<Image>) -> Result<Self> {
        // An array of no textures is not allowed; one slot that nothing reads is.
        let count = images.len().max(1) as u32;
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(count)
            .stage_flags(vk::ShaderStageFlags::ALL)];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let sizes = [vk::DescriptorPoolSize::default()
            .ty(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(count)];
        let pool_info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let sampler_info = vk::SamplerCreateInfo::default()
            .mag_filter(vk::Filter::LINEAR)
            .min_filter(vk::Filter::LINEAR);
        let mut table = Self {
            layout: vk::DescriptorSetLayout::null(),
            set: vk::DescriptorSet::null(),
            pool: vk::DescriptorPool::null(),
            sampler: vk::Sampler::null(),
            _images: images,
            gpu: gpu.clone(),
        };
        // SAFETY: the device is alive; whatever was made is destroyed with the table.
        unsafe {
            table.layout = gpu.device.create_descriptor_set_layout(&info, None)?;
            table.pool = gpu.device.create_descriptor_pool(&pool_info, None)?;
            table.sampler = gpu.device.create_sampler(&sampler_info, None)?;
            let layouts = [table.layout];
            let allocate = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(table.pool)
                .set_layouts(&layouts);
            table.set = gpu.device.allocate_descriptor_sets(&allocate)?[0];
        }
        let infos: Vec<_> = table
            ._images
            .iter()
            .map(|image| {
                vk::DescriptorImageInfo::default()
                    .sampler(table.sampler)
                    .image_view(image.view)
                    .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
            })
            .collect();
        if !infos.is_empty() {
            let write = vk::WriteDescriptorSet::default()
                .dst_set(table.set)
                .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                .image_info(&infos);
            // SAFETY: the set is not in use; the images live beside it.
            unsafe { gpu.device.update_descriptor_sets(&[write], &[]) };
        }
        gpu.name_object(table.set, "texture table");
        Ok(table)
    }
}

impl Drop for TextureTable {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe {
            self.gpu.device.destroy_descriptor_pool(self.pool, None);
            self.gpu.device.destroy_descriptor_set_layout(self.layout, None);
            self.gpu.device.destroy_sampler(self.sampler, None);
        }
    }
}
