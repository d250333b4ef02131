//! Pipelines: their stages, bindings, and how they are bound.

mod builder;
pub mod cache;
mod compute;
pub mod contraction;
pub mod desc;
pub mod enumeration;
mod graphics;
mod hit_group;
mod hit_records;
pub mod layout;
pub mod sbt;
pub mod shader;

use std::ops::Deref;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use anyhow::{Result, ensure};
use ash::vk;

pub use builder::PipelineBuilder;
pub use compute::{Band, ComputePipeline};
pub use graphics::GraphicsPipeline;
pub use hit_group::HitGroup;
pub use hit_records::{Asked, AskedRecord, RayRecord};

use super::{AccelerationStructure, Buffer, Gpu, Image, Record};
use crate::gpu::check::interface_check::Agreed;
use crate::gpu::pipeline::desc::{Binding, PipelineDesc, STAGES};
use crate::gpu::pipeline::layout::ShaderStruct;

/// A resource pushed to a binding for the next trace.
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
    /// The description it was created from.
    pub desc: Arc<PipelineDesc>,
    /// Time for compiling the shaders and creating the pipeline.
    pub build_time: Duration,
    textures: Option<vk::DescriptorSet>,
    /// Facts from its shaders that are checked when it is bound.
    pub(super) agreed: Agreed,
    set_layout: vk::DescriptorSetLayout,
    gpu: Gpu,
}

/// A pipeline of shader groups, and the nesting depth of its rays.
pub struct RayTracingPipeline {
    /// Number of groups of each kind: raygen, miss, hit, callable.
    pub groups: [usize; 4],
    /// The kind of hit group of each record in the largest table made for it.
    pub(super) hit_records: Mutex<Vec<vk::RayTracingShaderGroupTypeKHR>>,
    pipeline: Pipeline,
}

impl RayTracingPipeline {
    /// An empty pipeline, to be filled line by line; its shaders are in `shaders/{name}/`.
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

    /// Notes the hit records of a table that was made for it.
    pub(super) fn knows_hit_records(&self, hit: &[Record]) {
        let [raygen, miss, ..] = self.groups;
        let kind = |record: &Record| self.desc.groups[raygen + miss + record.group].kind;
        let kinds = hit.iter().map(kind).map(vk::RayTracingShaderGroupTypeKHR::from_raw);
        let mut known = self.hit_records.lock().unwrap_or_else(PoisonError::into_inner);
        if hit.len() > known.len() {
            *known = kinds.collect();
        }
    }

    /// As [`Pipeline::bind`]; also checks that each instance's hit record is in the table and of the right kind.
    ///
    /// # Errors
    /// As [`Pipeline::bind`]; if an instance uses a missing record, or one of the wrong kind.
    pub fn bind<T: ShaderStruct>(
        &self,
        cmd: vk::CommandBuffer,
        descriptors: &[Descriptor],
        push: &T,
    ) -> Result<()> {
        let records = self.hit_records.lock().unwrap_or_else(PoisonError::into_inner);
        for descriptor in descriptors {
            if let Descriptor::AccelerationStructure(AccelerationStructure { asked, .. }) =
                descriptor
                && !records.is_empty()
            {
                hit_records::check(asked, &records, &self.agreed.rays, &self.desc.name)?;
            }
        }
        drop(records);
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
    /// Binds the pipeline, its textures, one descriptor per binding, and the push constants.
    ///
    /// # Errors
    /// If the descriptors or push constants differ from those the pipeline was made for.
    pub fn bind<T: ShaderStruct>(
        &self,
        cmd: vk::CommandBuffer,
        descriptors: &[Descriptor],
        push: &T,
    ) -> Result<()> {
        let PipelineDesc { name, bindings, push_size, .. } = &*self.desc;
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
        self.check_addresses(push)?;
        let (device, point) = (&self.gpu.device, self.desc.bind_point());
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

    /// Checks that there is a buffer at each address in the push constants; 0 means none.
    fn check_addresses<T: ShaderStruct>(&self, push: &T) -> Result<()> {
        let mut offsets = Vec::new();
        T::addresses(0, &mut offsets);
        for offset in offsets {
            let bytes = &bytemuck::bytes_of(push)[offset..][..size_of::<vk::DeviceAddress>()];
            let address: vk::DeviceAddress = bytemuck::pod_read_unaligned(bytes);
            let field = T::LAYOUT.fields.iter().rev().find(|(_, at, _)| *at <= offset);
            ensure!(
                address == 0 || self.gpu.arrays().from(address).is_some(),
                "pipeline '{}': no buffer lies at {address:#x}, the address in {}.{}; was it dropped? It must live \
                 as long as it is read",
                self.desc.name,
                T::LAYOUT.name,
                field.map_or("", |(name, ..)| name)
            );
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
                self.agreed.check_format(binding, target)?;
                let info = vk::DescriptorImageInfo::default().image_view(target.view);
                image = [info.image_layout(vk::ImageLayout::GENERAL)];
                write.image_info(&image)
            }
            Descriptor::StorageBuffer(target) => {
                let most = self.gpu.limits.core.max_storage_buffer_range.into();
                ensure!(
                    target.size <= most,
                    "pipeline '{}' binds a buffer of {} bytes, and {} takes {most}",
                    self.desc.name,
                    target.size,
                    self.gpu.name
                );
                let info = vk::DescriptorBufferInfo::default().buffer(target.handle);
                buffer = [info.range(vk::WHOLE_SIZE)];
                write.buffer_info(&buffer)
            }
        };
        let (extension, point) = (&self.gpu.push_descriptor, self.desc.bind_point());
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

#[cfg(test)]
mod tests;
