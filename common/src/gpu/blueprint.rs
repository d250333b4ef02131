//! What a pipeline is made from, as plain data: enough to make it once more, on another device too.

mod graphics;

use anyhow::{Result, bail};
use ash::{Device, khr, vk};
use serde::{Deserialize, Serialize};

pub use graphics::Attachments;

/// The stages that a push constant or descriptor is visible in.
pub(super) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::ALL;

/// A pipeline before any driver has seen it: with attachments a graphics pipeline, with groups one that
/// traces rays, else a compute pipeline of its one stage. Vulkan's enumerations and flags are their numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Blueprint {
    /// The pipeline's name.
    pub name: String,
    /// The stages; groups name them by position.
    pub stages: Vec<Stage>,
    /// The shader groups: raygen, miss, hit, callable.
    pub groups: Vec<Group>,
    /// What a graphics pipeline draws to.
    pub attachments: Option<Attachments>,
    /// Specialization constants, given to every stage: number and value.
    pub constants: Vec<(u32, u32)>,
    /// The descriptor type of each binding of set 0, which holds push descriptors.
    pub bindings: Vec<i32>,
    /// How many textures set 1 has, if there is a set 1.
    pub textures: Option<u32>,
    /// Bytes of push constants.
    pub push_size: u32,
    /// How deep `traceRayEXT` nests.
    pub recursion: u32,
    /// `VkPipelineCreateFlags`.
    pub flags: u32,
}

/// A compiled stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    /// The shader's path below `shaders/`.
    pub path: String,
    /// `VkShaderStageFlagBits`.
    pub stage: u32,
    /// The module's words: what the driver is given.
    pub words: Vec<u32>,
}

/// A shader group: its type, and the stages it is made of (`VK_SHADER_UNUSED_KHR` for none).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

impl Blueprint {
    /// What the pipeline is bound as.
    pub fn bind_point(&self) -> vk::PipelineBindPoint {
        match (&self.attachments, self.groups.is_empty()) {
            (Some(_), _) => vk::PipelineBindPoint::GRAPHICS,
            (None, true) => vk::PipelineBindPoint::COMPUTE,
            (None, false) => vk::PipelineBindPoint::RAY_TRACING_KHR,
        }
    }

    /// The layout of set 0.
    ///
    /// # Errors
    /// If the device has no memory left.
    pub fn set_layout(&self, device: &Device) -> Result<vk::DescriptorSetLayout> {
        let slots: Vec<_> = self
            .bindings
            .iter()
            .enumerate()
            .map(|(index, &kind)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(index as u32)
                    .descriptor_type(vk::DescriptorType::from_raw(kind))
                    .descriptor_count(1)
                    .stage_flags(STAGES)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&slots);
        // SAFETY: the device is alive; the layout is the caller's.
        Ok(unsafe { device.create_descriptor_set_layout(&info, None)? })
    }

    /// The pipeline layout for these sets.
    ///
    /// # Errors
    /// If the device has no memory left.
    pub fn layout(
        &self,
        device: &Device,
        sets: &[vk::DescriptorSetLayout],
    ) -> Result<vk::PipelineLayout> {
        let ranges = [vk::PushConstantRange::default().stage_flags(STAGES).size(self.push_size)];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(sets);
        if self.push_size > 0 {
            info = info.push_constant_ranges(&ranges);
        }
        // SAFETY: the set layouts are alive; the layout is the caller's.
        Ok(unsafe { device.create_pipeline_layout(&info, None)? })
    }

    /// Makes the pipeline, with further flags; `name` hears of each module and its path. The cache may be
    /// null.
    ///
    /// # Errors
    /// If the driver cannot compile it.
    pub fn create(
        &self,
        device: &Device,
        ray_tracing_pipeline: &khr::ray_tracing_pipeline::Device,
        layout: vk::PipelineLayout,
        cache: vk::PipelineCache,
        flags: vk::PipelineCreateFlags,
        name: impl Fn(vk::ShaderModule, &str),
    ) -> Result<vk::Pipeline> {
        let entries: Vec<_> = (0..self.constants.len())
            .map(|i| {
                vk::SpecializationMapEntry::default()
                    .constant_id(self.constants[i].0)
                    .offset(4 * i as u32)
                    .size(4)
            })
            .collect();
        let values: Vec<u32> = self.constants.iter().map(|&(_, value)| value).collect();
        let specialization = vk::SpecializationInfo::default()
            .map_entries(&entries)
            .data(bytemuck::cast_slice(&values));
        let groups: Vec<_> = self.groups.iter().map(Group::info).collect();
        let mut created = Vec::new();
        let result = (|| -> Result<vk::Pipeline> {
            let mut infos = Vec::new();
            for stage in &self.stages {
                let info = vk::ShaderModuleCreateInfo::default().code(&stage.words);
                // SAFETY: the words are a valid module, compiled by glslang.
                let module = unsafe { device.create_shader_module(&info, None)? };
                created.push(module);
                name(module, &stage.path);
                infos.push(
                    vk::PipelineShaderStageCreateInfo::default()
                        .stage(vk::ShaderStageFlags::from_raw(stage.stage))
                        .module(module)
                        .name(c"main")
                        .specialization_info(&specialization),
                );
            }
            let flags = vk::PipelineCreateFlags::from_raw(self.flags) | flags;
            let pipelines = match (self.bind_point(), &infos[..]) {
                (vk::PipelineBindPoint::GRAPHICS, stages) => {
                    let attachments = self.attachments.clone().unwrap_or_default();
                    attachments.pipeline(device, stages, layout, cache, flags)
                }
                (vk::PipelineBindPoint::COMPUTE, [stage]) => {
                    let info = [vk::ComputePipelineCreateInfo::default()
                        .flags(flags)
                        .stage(*stage)
                        .layout(layout)];
                    // SAFETY: all handles are alive.
                    unsafe { device.create_compute_pipelines(cache, &info, None) }
                }
                (vk::PipelineBindPoint::COMPUTE, _) => bail!("a compute pipeline has one stage"),
                _ => {
                    let info = [vk::RayTracingPipelineCreateInfoKHR::default()
                        .flags(flags)
                        .stages(&infos)
                        .groups(&groups)
                        .max_pipeline_ray_recursion_depth(self.recursion)
                        .layout(layout)];
                    let deferred = vk::DeferredOperationKHR::null();
                    // SAFETY: every stage index of the groups is within the stages; all handles are alive.
                    unsafe {
                        ray_tracing_pipeline
                            .create_ray_tracing_pipelines(deferred, cache, &info, None)
                    }
                }
            };
            Ok(pipelines.map_err(|(_, error)| error)?[0])
        })();
        for module in created {
            // SAFETY: a module is not needed once the pipeline is made.
            unsafe { device.destroy_shader_module(module, None) };
        }
        result
    }
}

impl Group {
    /// A group of one raygen, miss or callable shader.
    pub fn general(stage: u32) -> Self {
        let unused = vk::SHADER_UNUSED_KHR;
        let kind = vk::RayTracingShaderGroupTypeKHR::GENERAL.as_raw();
        Self { kind, general: stage, intersection: unused, any_hit: unused, closest_hit: unused }
    }

    fn info(&self) -> vk::RayTracingShaderGroupCreateInfoKHR<'static> {
        vk::RayTracingShaderGroupCreateInfoKHR::default()
            .ty(vk::RayTracingShaderGroupTypeKHR::from_raw(self.kind))
            .general_shader(self.general)
            .intersection_shader(self.intersection)
            .any_hit_shader(self.any_hit)
            .closest_hit_shader(self.closest_hit)
    }
}
