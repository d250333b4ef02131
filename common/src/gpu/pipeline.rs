//! Pipelines: their stages, what they may bind, and how they are bound.

mod builder;
mod compute;
mod graphics;
mod hit_group;

use std::ops::Deref;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Result, ensure};
use ash::vk;

pub use builder::PipelineBuilder;
pub use compute::{Band, ComputePipeline};
pub use graphics::GraphicsPipeline;
pub use hit_group::HitGroup;

use super::blueprint::{Blueprint, STAGES};
use super::layout::ShaderStruct;
use super::{AccelerationStructure, Buffer, Gpu, Image};

/// What a binding of set 0 holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// A top level acceleration structure.
    AccelerationStructure,
    /// An image that shaders write.
    StorageImage,
    /// A buffer that shaders read and write.
    StorageBuffer,
}

impl Binding {
    fn descriptor_type(self) -> vk::DescriptorType {
        match self {
            Self::AccelerationStructure => vk::DescriptorType::ACCELERATION_STRUCTURE_KHR,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        }
    }
}

/// What is pushed to a binding for the next trace.
#[derive(Clone, Copy)]
pub enum Descriptor<'a> {
    /// For [`Binding::AccelerationStructure`].
    AccelerationStructure(&'a AccelerationStructure),
    /// For [`Binding::StorageImage`], in layout `GENERAL`.
    StorageImage(&'a Image),
    /// For [`Binding::StorageBuffer`].
    StorageBuffer(&'a Buffer),
}

/// A `VkPipeline` of any kind with its layout, freed on drop.
pub struct Pipeline {
    /// The Vulkan handle.
    pub handle: vk::Pipeline,
    /// The pipeline layout.
    pub layout: vk::PipelineLayout,
    /// What it was made from.
    pub blueprint: Arc<Blueprint>,
    /// How long compiling the shaders and making the pipeline took.
    pub build_time: Duration,
    bindings: Vec<Binding>,
    textures: Option<vk::DescriptorSet>,
    set_layout: vk::DescriptorSetLayout,
    gpu: Gpu,
}

/// A pipeline of shader groups, and how deep its rays nest.
pub struct RayTracingPipeline {
    /// How many groups there are of each kind: raygen, miss, hit, callable.
    pub groups: [usize; 4],
    pipeline: Pipeline,
}

impl RayTracingPipeline {
    /// An empty pipeline, to be filled line by line; its shaders lie in `shaders/{name}/`.
    pub fn builder(name: &str) -> PipelineBuilder<'_> {
        PipelineBuilder::new(name)
    }
}

impl Deref for RayTracingPipeline {
    type Target = Pipeline;

    fn deref(&self) -> &Pipeline {
        &self.pipeline
    }
}

impl Pipeline {
    /// Binds the pipeline, its textures, one descriptor for each binding, and the push constants.
    ///
    /// # Errors
    /// If descriptors or push constants are not those that the pipeline was made for.
    pub fn bind<T: ShaderStruct>(
        &self,
        cmd: vk::CommandBuffer,
        descriptors: &[Descriptor],
        push: &T,
    ) -> Result<()> {
        let kinds: Vec<Binding> = descriptors.iter().map(Descriptor::binding).collect();
        ensure!(
            kinds == self.bindings,
            "pipeline '{}' binds {:?}, not {kinds:?}",
            self.blueprint.name,
            self.bindings
        );
        let bytes = bytemuck::bytes_of(push);
        ensure!(
            bytes.len() == self.blueprint.push_size as usize,
            "pipeline '{}' takes {} bytes of push constants, not {}",
            self.blueprint.name,
            self.blueprint.push_size,
            bytes.len()
        );
        for descriptor in descriptors {
            let Descriptor::StorageBuffer(buffer) = descriptor else { continue };
            let most = self.gpu.limits.max_storage_buffer_range;
            ensure!(
                buffer.size <= most,
                "pipeline '{}' binds a buffer of {} bytes, and {} takes {most}",
                self.blueprint.name,
                buffer.size,
                self.gpu.name
            );
        }
        let point = self.blueprint.bind_point();
        // SAFETY: cmd is being recorded; the pipeline and its descriptors outlive the submission.
        unsafe {
            self.gpu.device.cmd_bind_pipeline(cmd, point, self.handle);
            if let Some(textures) = self.textures {
                let sets = [textures];
                self.gpu.device.cmd_bind_descriptor_sets(cmd, point, self.layout, 1, &sets, &[]);
            }
            self.gpu.device.cmd_push_constants(cmd, self.layout, STAGES, 0, bytes);
        }
        for (binding, descriptor) in descriptors.iter().enumerate() {
            self.push_descriptor(cmd, binding as u32, descriptor);
        }
        Ok(())
    }

    fn push_descriptor(&self, cmd: vk::CommandBuffer, binding: u32, descriptor: &Descriptor) {
        let (structure, image, buffer);
        let mut in_structure;
        let write = vk::WriteDescriptorSet::default()
            .dst_binding(binding)
            .descriptor_count(1)
            .descriptor_type(descriptor.binding().descriptor_type());
        let write = match descriptor {
            Descriptor::AccelerationStructure(tlas) => {
                structure = [tlas.handle];
                in_structure = vk::WriteDescriptorSetAccelerationStructureKHR::default()
                    .acceleration_structures(&structure);
                write.push_next(&mut in_structure)
            }
            Descriptor::StorageImage(target) => {
                image = [vk::DescriptorImageInfo::default()
                    .image_view(target.view)
                    .image_layout(vk::ImageLayout::GENERAL)];
                write.image_info(&image)
            }
            Descriptor::StorageBuffer(target) => {
                buffer = [vk::DescriptorBufferInfo::default()
                    .buffer(target.handle)
                    .range(vk::WHOLE_SIZE)];
                write.buffer_info(&buffer)
            }
        };
        let point = self.blueprint.bind_point();
        // SAFETY: set 0 was made for push descriptors of these kinds; all handles are alive.
        unsafe {
            self.gpu.push_descriptor.cmd_push_descriptor_set(cmd, point, self.layout, 0, &[write]);
        }
    }
}

impl Descriptor<'_> {
    fn binding(&self) -> Binding {
        match self {
            Self::AccelerationStructure(_) => Binding::AccelerationStructure,
            Self::StorageImage(_) => Binding::StorageImage,
            Self::StorageBuffer(_) => Binding::StorageBuffer,
        }
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe {
            self.gpu.device.destroy_pipeline(self.handle, None);
            self.gpu.device.destroy_pipeline_layout(self.layout, None);
            self.gpu.device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}
