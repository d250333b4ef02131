//! The texture table: every texture of a scene in one array, which any shader indexes by number.

use anyhow::{Result, ensure};
use ash::vk;

use crate::gpu::{Gpu, Image, Sampling, Texels};

/// The descriptor type of each texture.
const TYPE: vk::DescriptorType = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;

/// Set 1 of every pipeline that reads textures: binding 0, an array of combined image samplers.
pub struct TextureTable {
    /// The layout of the set.
    pub layout: vk::DescriptorSetLayout,
    /// The set.
    pub set: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    /// One for each way in which textures are sampled.
    samplers: Vec<(Sampling, vk::Sampler)>,
    images: Vec<Image>,
    gpu: Gpu,
}

impl TextureTable {
    /// A table of textures, numbered by position. With `mipmaps`, they have all mip levels, and a lookup between two
    /// levels blends them.
    ///
    /// # Errors
    /// If the device does not support so many.
    pub fn new(gpu: &Gpu, textures: &[Texels], mipmaps: bool) -> Result<Self> {
        // An empty array is not allowed, nor is a slot without a texture.
        let extent = vk::Extent2D { width: 1, height: 1 };
        let sampling = Sampling::default();
        let name = "no texture";
        let none = [Texels { name, extent, rgba: &[255; 4], srgb: false, halves: false, sampling }];
        let textures = if textures.is_empty() { &none } else { textures };
        let count = textures.len() as u32;
        fits(count, gpu.limits.max_textures(), &gpu.name)?;
        let images = Image::textures(gpu, textures, mipmaps)?;
        let sizes = [vk::DescriptorPoolSize { ty: TYPE, descriptor_count: count }];
        let pool_info = vk::DescriptorPoolCreateInfo::default()
            .flags(vk::DescriptorPoolCreateFlags::UPDATE_AFTER_BIND)
            .max_sets(1)
            .pool_sizes(&sizes);
        let mut table = Self {
            layout: Self::layout(gpu, count)?,
            set: vk::DescriptorSet::null(),
            pool: vk::DescriptorPool::null(),
            samplers: Vec::new(),
            images,
            gpu: gpu.clone(),
        };
        // SAFETY: the device is alive; whatever was made is destroyed with the table.
        unsafe {
            table.pool = gpu.device.create_descriptor_pool(&pool_info, None)?;
            let layouts = [table.layout];
            let allocate = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(table.pool)
                .set_layouts(&layouts);
            table.set = gpu.device.allocate_descriptor_sets(&allocate)?[0];
        }
        let used = textures.iter().map(|texels| table.sampler(texels.sampling, mipmaps));
        let used: Vec<_> = used.collect::<Result<_>>()?;
        let infos = table.images.iter().zip(used).map(|(image, sampler)| vk::DescriptorImageInfo {
            sampler,
            image_view: image.view,
            image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        });
        let infos: Vec<_> = infos.collect();
        let write = vk::WriteDescriptorSet::default()
            .dst_set(table.set)
            .descriptor_type(TYPE)
            .image_info(&infos);
        // SAFETY: the set is not in use; the images live beside it.
        unsafe { gpu.device.update_descriptor_sets(&[write], &[]) };
        let name = "texture table";
        gpu.name_object(table.set, name);
        gpu.name_object(table.layout, name);
        gpu.name_object(table.pool, name);
        for (_, sampler) in &table.samplers {
            gpu.name_object(*sampler, name);
        }
        Ok(table)
    }

    /// The sampler for textures that are sampled so, made if it is the first.
    fn sampler(&mut self, sampling: Sampling, mipmaps: bool) -> Result<vk::Sampler> {
        if let Some((_, known)) = self.samplers.iter().find(|(known, _)| *known == sampling) {
            return Ok(*known);
        }
        // SAFETY: the device is alive; the sampler is destroyed with the table.
        let sampler = unsafe { self.gpu.device.create_sampler(&sampling.info(mipmaps), None)? };
        self.samplers.push((sampling, sampler));
        Ok(sampler)
    }

    /// Number of textures, at least one.
    pub fn count(&self) -> u32 {
        self.images.len() as u32
    }

    /// The layout of a table of `count` textures.
    ///
    /// # Errors
    /// If the device has no memory left.
    pub fn layout(gpu: &Gpu, count: u32) -> Result<vk::DescriptorSetLayout> {
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(TYPE)
            .descriptor_count(count)
            .stage_flags(vk::ShaderStageFlags::ALL)];
        // Nothing is updated after binding. But a device must support 500,000 descriptors of the kind that may be,
        // and only 16 others (`maxPerStageDescriptorSamplers`).
        let flags = [vk::DescriptorBindingFlags::UPDATE_AFTER_BIND];
        let mut flags =
            vk::DescriptorSetLayoutBindingFlagsCreateInfo::default().binding_flags(&flags);
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::UPDATE_AFTER_BIND_POOL)
            .bindings(&bindings)
            .push_next(&mut flags);
        // SAFETY: the device is alive; the layout is the caller's.
        Ok(unsafe { gpu.device.create_descriptor_set_layout(&info, None)? })
    }
}

fn fits(count: u32, most: u32, device: &str) -> Result<()> {
    ensure!(
        count <= most,
        "the scene has {count} textures, and {device} takes {most}: leave out some, or join them"
    );
    Ok(())
}

impl Drop for TextureTable {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe {
            self.gpu.device.destroy_descriptor_pool(self.pool, None);
            self.gpu.device.destroy_descriptor_set_layout(self.layout, None);
            for (_, sampler) in &self.samplers {
                self.gpu.device.destroy_sampler(*sampler, None);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_textures_than_a_device_takes_are_refused_by_number() {
        fits(500_000, 500_000, "a GPU").unwrap();
        let error = fits(500_001, 500_000, "a GPU").unwrap_err().to_string();
        assert!(
            error.starts_with("the scene has 500001 textures, and a GPU takes 500000"),
            "{error}"
        );
    }
}
