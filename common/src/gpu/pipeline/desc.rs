//! A pipeline's description as plain data: enough to create it again, even on another device.

mod graphics;

use anyhow::{Result, bail};
use ash::{Device, vk};
use serde::{Deserialize, Serialize};

pub use graphics::Attachments;

use crate::gpu::Gpu;

/// The stages in which push constants and descriptors are visible.
pub(in crate::gpu) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::ALL;

/// The kind of resource in a binding of set 0. Bindings are numbered in the order of the pipeline's
/// [`binding`](crate::gpu::PipelineBuilder::binding) lines; each frame pushes a
/// [`Descriptor`](crate::gpu::Descriptor) for each.
///
/// ```no_run
/// use raybook::prelude::*;
///
/// /// For `.binding(Binding::AccelerationStructure).binding(Binding::StorageImage)`.
/// fn descriptors<'a>(tlas: &'a AccelerationStructure, frame: &'a Frame) -> [Descriptor<'a>; 2] {
///     [Descriptor::AccelerationStructure(tlas), Descriptor::StorageImage(frame.image)]
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Binding {
    /// A top-level acceleration structure.
    AccelerationStructure,
    /// An image that shaders write.
    StorageImage,
    /// A buffer that shaders read and write.
    StorageBuffer,
}

impl Binding {
    /// The kind of resource, in words.
    pub(in crate::gpu) fn kind(self) -> &'static str {
        match self {
            Self::AccelerationStructure => "an acceleration structure",
            Self::StorageImage => "an image",
            Self::StorageBuffer => "a buffer",
        }
    }

    pub(in crate::gpu) fn descriptor_type(self) -> vk::DescriptorType {
        match self {
            Self::AccelerationStructure => vk::DescriptorType::ACCELERATION_STRUCTURE_KHR,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        }
    }
}

/// A pipeline before any driver has seen it: a graphics pipeline if it has attachments, a ray tracing pipeline if
/// it has groups, else a compute pipeline of its one stage. Vulkan's enumerations and flags are stored as numbers.
#[derive(Clone, Debug, Default, PartialEq, Hash, Serialize, Deserialize)]
pub struct PipelineDesc {
    /// The pipeline's name.
    pub name: String,
    /// The stages; groups name them by position.
    pub stages: Vec<Stage>,
    /// The shader groups: raygen, miss, hit, callable.
    pub groups: Vec<Group>,
    /// The attachments of a graphics pipeline.
    pub attachments: Option<Attachments>,
    /// Specialization constants, given to every stage: number and value.
    pub constants: Vec<[u32; 2]>,
    /// The bindings of set 0, which holds push descriptors.
    pub bindings: Vec<Binding>,
    /// Number of textures in set 1; `None` if there is no set 1.
    pub textures: Option<u32>,
    /// Bytes of push constants.
    pub push_size: u32,
    /// The nesting depth of `traceRayEXT`.
    pub recursion: u32,
    /// `VkPipelineCreateFlags`.
    pub flags: u32,
}

/// A stage. Until the pipeline is built, only its path is known.
#[derive(Clone, Debug, Default, PartialEq, Hash, Serialize, Deserialize)]
pub struct Stage {
    /// The shader's path below `shaders/`.
    pub path: String,
    /// `VkShaderStageFlagBits`.
    pub stage: u32,
    /// The SPIR-V words passed to the driver.
    pub words: Vec<u32>,
}

/// A shader group: its type and stages (`VK_SHADER_UNUSED_KHR` for none).
#[derive(Clone, Copy, Debug, PartialEq, Hash, Serialize, Deserialize)]
pub struct Group {
    /// `VkRayTracingShaderGroupTypeKHR`.
    pub kind: i32,
    /// The raygen, miss or callable shader.
    pub general: u32,
    /// The intersection shader.
    pub intersection: u32,
    /// The any-hit shader.
    pub any_hit: u32,
    /// The closest hit shader.
    pub closest_hit: u32,
}

impl PipelineDesc {
    /// The bind point of the pipeline.
    pub fn bind_point(&self) -> vk::PipelineBindPoint {
        match &self.attachments {
            _ if !self.groups.is_empty() => vk::PipelineBindPoint::RAY_TRACING_KHR,
            Some(_) => vk::PipelineBindPoint::GRAPHICS,
            None => vk::PipelineBindPoint::COMPUTE,
        }
    }

    /// The layout of set 0, and the pipeline layout: set 0, set 1 of the given layout if there are textures, and
    /// the push constants.
    ///
    /// # Errors
    /// If the device has no memory left.
    pub fn layouts(
        &self,
        gpu: &Gpu,
        textures: Option<vk::DescriptorSetLayout>,
    ) -> Result<(vk::DescriptorSetLayout, vk::PipelineLayout)> {
        let mut slots = Vec::new();
        for (binding, kind) in (0..).zip(&self.bindings) {
            let slot = vk::DescriptorSetLayoutBinding::default().binding(binding);
            let slot = slot.descriptor_type(kind.descriptor_type()).descriptor_count(1);
            slots.push(slot.stage_flags(STAGES));
        }
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&slots);
        // SAFETY: the device is alive; both layouts are the caller's.
        let set = unsafe { gpu.device.create_descriptor_set_layout(&info, None)? };
        let sets: Vec<_> = [set].into_iter().chain(textures).collect();
        let ranges = [vk::PushConstantRange::default().stage_flags(STAGES).size(self.push_size)];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        if self.push_size > 0 {
            info = info.push_constant_ranges(&ranges);
        }
        // SAFETY: the layouts of the sets are alive.
        let layout = unsafe { gpu.device.create_pipeline_layout(&info, None) };
        // SAFETY: nothing was made of it.
        let destroy = |_: &_| unsafe { gpu.device.destroy_descriptor_set_layout(set, None) };
        Ok((set, layout.inspect_err(destroy)?))
    }

    /// Creates the pipeline. The cache may be null.
    ///
    /// # Errors
    /// If the driver cannot compile it.
    pub fn create(
        &self,
        gpu: &Gpu,
        layout: vk::PipelineLayout,
        cache: vk::PipelineCache,
    ) -> Result<vk::Pipeline> {
        let device = &gpu.device;
        // Packed values: RADV compiles a different program if the constants' numbers are stored between them.
        let (mut entries, mut values) = (Vec::new(), Vec::new());
        for (index, &[constant_id, value]) in (0..).zip(&self.constants) {
            entries.push(vk::SpecializationMapEntry { constant_id, offset: 4 * index, size: 4 });
            values.push(value);
        }
        let specialization = vk::SpecializationInfo::default()
            .map_entries(&entries)
            .data(bytemuck::cast_slice(&values));
        let (mut modules, mut stages) = (Modules { device, handles: Vec::new() }, Vec::new());
        for Stage { path, stage, words } in &self.stages {
            let info = vk::ShaderModuleCreateInfo::default().code(words);
            // SAFETY: the words are a valid module, compiled by glslang.
            let module = unsafe { device.create_shader_module(&info, None)? };
            modules.handles.push(module);
            gpu.name_object(module, path);
            let stage = vk::ShaderStageFlags::from_raw(*stage);
            let info = vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module);
            stages.push(info.name(c"main").specialization_info(&specialization));
        }
        let flags = vk::PipelineCreateFlags::from_raw(self.flags);
        let pipelines = match (&self.attachments, &stages[..]) {
            (_, stages) if !self.groups.is_empty() => {
                let groups: Vec<_> = self.groups.iter().map(Group::info).collect();
                let info = [vk::RayTracingPipelineCreateInfoKHR::default()
                    .flags(flags)
                    .stages(stages)
                    .groups(&groups)
                    .max_pipeline_ray_recursion_depth(self.recursion)
                    .layout(layout)];
                let deferred = vk::DeferredOperationKHR::null();
                // SAFETY: every stage index of the groups is within the stages; all handles are alive.
                unsafe {
                    let extension = &gpu.ray_tracing_pipeline;
                    extension.create_ray_tracing_pipelines(deferred, cache, &info, None)
                }
            }
            (Some(attachments), stages) => {
                attachments.pipeline(device, stages, layout, cache, flags)
            }
            (None, &[stage]) => {
                let info = vk::ComputePipelineCreateInfo::default();
                let info = [info.flags(flags).stage(stage).layout(layout)];
                // SAFETY: all handles are alive.
                unsafe { device.create_compute_pipelines(cache, &info, None) }
            }
            (None, _) => bail!("a compute pipeline has one stage"),
        };
        Ok(pipelines.map_err(|(_, error)| error)?[0])
    }
}

/// The shader modules of a pipeline, needed only until it has been created.
struct Modules<'a> {
    device: &'a Device,
    handles: Vec<vk::ShaderModule>,
}

impl Drop for Modules<'_> {
    fn drop(&mut self) {
        for &module in &self.handles {
            // SAFETY: the module is this device's, and no pipeline is being made of it.
            unsafe { self.device.destroy_shader_module(module, None) };
        }
    }
}

impl Default for Group {
    /// A group of one raygen, miss or callable shader, still to be set.
    fn default() -> Self {
        let kind = vk::RayTracingShaderGroupTypeKHR::GENERAL.as_raw();
        let unused = vk::SHADER_UNUSED_KHR;
        let [general, intersection, any_hit, closest_hit] = [unused; 4];
        Self { kind, general, intersection, any_hit, closest_hit }
    }
}

impl Group {
    fn info(&self) -> vk::RayTracingShaderGroupCreateInfoKHR<'static> {
        vk::RayTracingShaderGroupCreateInfoKHR::default()
            .ty(vk::RayTracingShaderGroupTypeKHR::from_raw(self.kind))
            .general_shader(self.general)
            .intersection_shader(self.intersection)
            .any_hit_shader(self.any_hit)
            .closest_hit_shader(self.closest_hit)
    }
}
