//! A pipeline put together line by line.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use ash::vk;

use super::stages::{HitGroup, Stages, general};
use super::{Binding, RayTracingPipeline, STAGES};
use crate::gpu::Gpu;
use crate::gpu::layout::{Reflection, ShaderStruct, StructLayout};
use crate::gpu::texture::TextureTable;

/// Collects what a pipeline is made of. Begin with [`RayTracingPipeline::builder`].
pub struct PipelineBuilder<'a> {
    name: &'a str,
    raygen: Vec<&'a str>,
    miss: Vec<&'a str>,
    hit: Vec<HitGroup<'a>>,
    callable: Vec<&'a str>,
    bindings: Vec<Binding>,
    textures: Option<&'a TextureTable>,
    push: Option<StructLayout>,
    hit_data: Option<StructLayout>,
    constants: Vec<(u32, u32)>,
    defines: Vec<(&'a str, String)>,
    recursion: u32,
    flags: vk::PipelineCreateFlags,
    exact: bool,
}

impl<'a> PipelineBuilder<'a> {
    pub(super) fn new(name: &'a str) -> Self {
        Self {
            name,
            raygen: Vec::new(),
            miss: Vec::new(),
            hit: Vec::new(),
            callable: Vec::new(),
            bindings: Vec::new(),
            textures: None,
            push: None,
            hit_data: None,
            constants: Vec::new(),
            defines: Vec::new(),
            recursion: 1,
            flags: vk::PipelineCreateFlags::empty(),
            exact: false,
        }
    }

    /// Adds a ray generation shader; `vkCmdTraceRaysKHR` starts the first.
    pub fn raygen(mut self, shader: &'a str) -> Self {
        self.raygen.push(shader);
        self
    }

    /// Adds a miss shader; `traceRayEXT` chooses by position.
    pub fn miss(mut self, shader: &'a str) -> Self {
        self.miss.push(shader);
        self
    }

    /// Adds a hit group.
    pub fn hit(mut self, group: HitGroup<'a>) -> Self {
        self.hit.push(group);
        self
    }

    /// Adds a callable shader; `executeCallableEXT` chooses by position.
    pub fn callable(mut self, shader: &'a str) -> Self {
        self.callable.push(shader);
        self
    }

    /// Adds the next binding of set 0.
    pub fn binding(mut self, binding: Binding) -> Self {
        self.bindings.push(binding);
        self
    }

    /// Makes set 1 the texture table.
    pub fn textures(mut self, textures: &'a TextureTable) -> Self {
        self.textures = Some(textures);
        self
    }

    /// Declares the push constants, checked against the block of the same name in every shader.
    pub fn push_constants<T: ShaderStruct>(mut self) -> Self {
        self.push = Some(T::LAYOUT);
        self
    }

    /// Declares the data of hit records, checked against the `shaderRecordEXT` block of the same name.
    pub fn hit_data<T: ShaderStruct>(mut self) -> Self {
        self.hit_data = Some(T::LAYOUT);
        self
    }

    /// Sets the specialization constant `id` in every stage that has it.
    pub fn constant(mut self, id: u32, value: u32) -> Self {
        self.constants.push((id, value));
        self
    }

    /// Defines a macro in every stage, for code that shall not even be compiled.
    pub fn define(mut self, name: &'a str, value: impl ToString) -> Self {
        self.defines.push((name, value.to_string()));
        self
    }

    /// How deep `traceRayEXT` nests: 1 is a ray from the raygen shader, 2 a ray from its hit.
    pub fn recursion(mut self, depth: u32) -> Self {
        self.recursion = depth;
        self
    }

    /// Has all arithmetic done as it is written, so that a result does not depend on what else is
    /// compiled beside it.
    pub fn exact(mut self) -> Self {
        self.exact = true;
        self
    }

    /// Promises that rays shall skip all triangles, or all boxes: where the device has
    /// [`Limits::primitive_culling`](super::Limits), and only one of the two.
    pub fn skip(mut self, flags: vk::PipelineCreateFlags) -> Self {
        self.flags |= flags;
        self
    }

    /// Compiles the shaders and makes the pipeline.
    ///
    /// # Errors
    /// If a shader does not compile, a structure differs between Rust and GLSL, or the device allows
    /// less recursion or fewer push constants.
    pub fn build(self, gpu: &Gpu) -> Result<RayTracingPipeline> {
        let start = Instant::now();
        let limit = gpu.limits.max_ray_recursion_depth;
        ensure!(
            self.recursion <= limit,
            "pipeline '{}' needs a recursion depth of {}; {} allows {limit}",
            self.name,
            self.recursion,
            gpu.name
        );
        let push_size = self.push.map_or(0, |push| push.size);
        ensure!(
            push_size <= gpu.limits.max_push_constants_size as usize,
            "pipeline '{}' has {push_size} bytes of push constants; {} allows {}",
            self.name,
            gpu.name,
            gpu.limits.max_push_constants_size
        );
        let defines = self.defines.as_slice();
        let mut stages =
            Stages { folder: self.name, defines, exact: self.exact, shaders: Vec::new() };
        let mut groups = Vec::new();
        for shader in self.raygen.iter().chain(&self.miss) {
            groups.push(general(stages.add(shader)?));
        }
        for hit in &self.hit {
            groups.push(stages.hit_group(hit)?);
        }
        for shader in &self.callable {
            groups.push(general(stages.add(shader)?));
        }
        let own = self.push.into_iter().chain(self.hit_data).collect();
        let shared = [gpu.shared_structs(), own].concat();
        for shader in &stages.shaders {
            Reflection::of(&shader.spirv)?.check(&shader.path, &shared)?;
        }
        let mut pipeline = RayTracingPipeline {
            handle: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            name: self.name.to_owned(),
            groups: [self.raygen.len(), self.miss.len(), self.hit.len(), self.callable.len()],
            stages: stages.shaders.iter().map(|shader| shader.path.clone()).collect(),
            modules: Vec::new(),
            build_time: Duration::ZERO,
            push_size,
            textures: self.textures.map(|table| table.set),
            set_layout: push_descriptor_layout(gpu, &self.bindings)?,
            bindings: self.bindings.clone(),
            gpu: gpu.clone(),
        };
        pipeline.layout = self.pipeline_layout(gpu, pipeline.set_layout, push_size as u32)?;
        pipeline.handle = self
            .create(gpu, &stages, &groups, pipeline.layout)
            .with_context(|| format!("cannot make the pipeline '{}'", self.name))?;
        pipeline.modules = stages.shaders.into_iter().map(|shader| shader.spirv).collect();
        gpu.name_object(pipeline.handle, self.name);
        gpu.name_object(pipeline.layout, self.name);
        pipeline.build_time = start.elapsed();
        gpu.count(|statistics| {
            statistics.pipeline_time += pipeline.build_time;
            statistics.stages.extend(pipeline.stages.iter().cloned());
            statistics.groups += groups.len();
        });
        Ok(pipeline)
    }

    fn pipeline_layout(
        &self,
        gpu: &Gpu,
        set: vk::DescriptorSetLayout,
        push_size: u32,
    ) -> Result<vk::PipelineLayout> {
        let mut sets = vec![set];
        sets.extend(self.textures.map(|table| table.layout));
        let ranges = [vk::PushConstantRange::default().stage_flags(STAGES).size(push_size)];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        if push_size > 0 {
            info = info.push_constant_ranges(&ranges);
        }
        // SAFETY: the set layouts are alive.
        Ok(unsafe { gpu.device.create_pipeline_layout(&info, None)? })
    }

    fn create(
        &self,
        gpu: &Gpu,
        stages: &Stages,
        groups: &[vk::RayTracingShaderGroupCreateInfoKHR],
        layout: vk::PipelineLayout,
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
        let mut created = Vec::new();
        let result = (|| -> Result<vk::Pipeline> {
            let mut infos = Vec::new();
            for shader in &stages.shaders {
                let info = vk::ShaderModuleCreateInfo::default().code(&shader.spirv);
                // SAFETY: the words are a valid module, compiled by glslang.
                let module = unsafe { gpu.device.create_shader_module(&info, None)? };
                created.push(module);
                gpu.name_object(module, &shader.path);
                infos.push(
                    vk::PipelineShaderStageCreateInfo::default()
                        .stage(shader.stage)
                        .module(module)
                        .name(c"main")
                        .specialization_info(&specialization),
                );
            }
            let info = [vk::RayTracingPipelineCreateInfoKHR::default()
                .flags(self.flags)
                .stages(&infos)
                .groups(groups)
                .max_pipeline_ray_recursion_depth(self.recursion)
                .layout(layout)];
            // SAFETY: every stage index of the groups is within the stages; all handles are alive.
            let pipelines = unsafe {
                gpu.ray_tracing_pipeline.create_ray_tracing_pipelines(
                    vk::DeferredOperationKHR::null(),
                    vk::PipelineCache::null(),
                    &info,
                    None,
                )
            };
            Ok(pipelines.map_err(|(_, error)| error)?[0])
        })();
        for module in created {
            // SAFETY: a module is not needed once the pipeline is made.
            unsafe { gpu.device.destroy_shader_module(module, None) };
        }
        result
    }
}

fn push_descriptor_layout(gpu: &Gpu, bindings: &[Binding]) -> Result<vk::DescriptorSetLayout> {
    let slots: Vec<_> = bindings
        .iter()
        .enumerate()
        .map(|(index, binding)| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(index as u32)
                .descriptor_type(binding.descriptor_type())
                .descriptor_count(1)
                .stage_flags(STAGES)
        })
        .collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default()
        .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
        .bindings(&slots);
    // SAFETY: the device is alive; the layout is destroyed with the pipeline.
    Ok(unsafe { gpu.device.create_descriptor_set_layout(&info, None)? })
}
