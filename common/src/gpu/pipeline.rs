//! Pipelines: their stages, what they may bind, and how they are bound.

mod builder;
mod compute;
mod graphics;
mod hit_group;

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use anyhow::{Result, ensure};
use ash::vk;

pub use builder::PipelineBuilder;
pub use compute::{Band, ComputePipeline};
pub use graphics::GraphicsPipeline;
pub use hit_group::HitGroup;

use super::blueprint::{Binding, Blueprint, STAGES};
use super::layout::ShaderStruct;
use super::{AccelerationStructure, Buffer, Gpu, Image};

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
    textures: Option<vk::DescriptorSet>,
    set_layout: vk::DescriptorSetLayout,
    gpu: Gpu,
}

/// A pipeline of shader groups, and how deep its rays nest.
pub struct RayTracingPipeline {
    /// How many groups there are of each kind: raygen, miss, hit, callable.
    pub groups: [usize; 4],
    /// How many hit records the largest table made for it has.
    pub(super) hit_records: AtomicU32,
    pipeline: Pipeline,
}

impl RayTracingPipeline {
    /// An empty pipeline, to be filled line by line; its shaders lie in `shaders/{name}/`.
    ///
    /// ```no_run
    /// use raybook::prelude::*;
    ///
    /// raybook::shader_struct! { struct Push { camera: CameraBasis } }
    ///
    /// fn pipeline(gpu: &Gpu) -> Result<RayTracingPipeline> {
    ///     RayTracingPipeline::builder("my_tracer")
    ///         .raygen("camera.rgen")
    ///         .miss("sky.rmiss")
    ///         .hit(HitGroup::procedural("sphere.rint").closest_hit("sphere.rchit"))
    ///         .binding(Binding::AccelerationStructure)
    ///         .binding(Binding::StorageImage)
    ///         .push_constants::<Push>()
    ///         .build(gpu)
    /// }
    /// ```
    pub fn builder(name: &str) -> PipelineBuilder<'_> {
        PipelineBuilder::new(name)
    }

    /// As [`Pipeline::bind`]; and holds that each instance's hit record is in the table.
    ///
    /// # Errors
    /// As [`Pipeline::bind`]; if an instance needs a record that there is not.
    pub fn bind<T: ShaderStruct>(
        &self,
        cmd: vk::CommandBuffer,
        descriptors: &[Descriptor],
        push: &T,
    ) -> Result<()> {
        let records = self.hit_records.load(Ordering::Relaxed);
        for descriptor in descriptors {
            if let Descriptor::AccelerationStructure(AccelerationStructure { hit_records, .. }) =
                descriptor
                && records > 0
            {
                ensure!(
                    *hit_records <= records,
                    "an instance of the top level has the hit record {}, and the shader binding table of '{}' \
                     has {records}, counted from 0 in the order of the .hit lines",
                    hit_records - 1,
                    self.blueprint.name
                );
            }
        }
        self.pipeline.bind(cmd, descriptors, push)
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
        let Blueprint { name, bindings, push_size, .. } = &*self.blueprint;
        let kinds = || descriptors.iter().map(Descriptor::binding);
        ensure!(
            kinds().eq(bindings.iter().copied()),
            "pipeline '{name}' binds {bindings:?}, not {:?}",
            kinds().collect::<Vec<_>>()
        );
        let bytes = bytemuck::bytes_of(push);
        ensure!(
            bytes.len() == *push_size as usize,
            "pipeline '{name}' takes {push_size} bytes of push constants, not {}",
            bytes.len()
        );
        let (device, point) = (&self.gpu.device, self.blueprint.bind_point());
        // SAFETY: cmd is being recorded; the pipeline and its descriptors outlive the submission.
        unsafe {
            device.cmd_bind_pipeline(cmd, point, self.handle);
            if let Some(set) = self.textures {
                device.cmd_bind_descriptor_sets(cmd, point, self.layout, 1, &[set], &[]);
            }
            device.cmd_push_constants(cmd, self.layout, STAGES, 0, bytes);
        }
        for (binding, descriptor) in (0..).zip(descriptors) {
            self.push(cmd, binding, descriptor)?;
        }
        Ok(())
    }

    /// Pushes one descriptor.
    fn push(&self, cmd: vk::CommandBuffer, binding: u32, descriptor: &Descriptor) -> Result<()> {
        let (structure, mut in_structure, image, buffer);
        let kind = descriptor.binding().descriptor_type();
        let write = vk::WriteDescriptorSet::default().dst_binding(binding).descriptor_type(kind);
        let write = match descriptor {
            Descriptor::AccelerationStructure(tlas) => {
                structure = [tlas.handle];
                in_structure = vk::WriteDescriptorSetAccelerationStructureKHR::default()
                    .acceleration_structures(&structure);
                write.descriptor_count(1).push_next(&mut in_structure)
            }
            Descriptor::StorageImage(target) => {
                let info = vk::DescriptorImageInfo::default().image_view(target.view);
                image = [info.image_layout(vk::ImageLayout::GENERAL)];
                write.image_info(&image)
            }
            Descriptor::StorageBuffer(target) => {
                let most = self.gpu.limits.core.max_storage_buffer_range.into();
                ensure!(
                    target.size <= most,
                    "pipeline '{}' binds a buffer of {} bytes, and {} takes {most}",
                    self.blueprint.name,
                    target.size,
                    self.gpu.name
                );
                let info = vk::DescriptorBufferInfo::default().buffer(target.handle);
                buffer = [info.range(vk::WHOLE_SIZE)];
                write.buffer_info(&buffer)
            }
        };
        let (extension, point) = (&self.gpu.push_descriptor, self.blueprint.bind_point());
        // SAFETY: set 0 was made for push descriptors of these kinds; all handles are alive.
        unsafe { extension.cmd_push_descriptor_set(cmd, point, self.layout, 0, &[write]) };
        Ok(())
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
