//! A ray tracing pipeline: shader groups, their stages, what they may bind, how deep they recurse.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use ash::vk;

use super::exact::exact;
use super::layout::{Reflection, ShaderStruct, StructLayout};
use super::shader::{self, Shader};
use super::texture::TextureTable;
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

/// A hit group: what happens where a ray meets one kind of geometry.
#[derive(Clone, Copy, Default)]
pub struct HitGroup<'a> {
    intersection: Option<&'a str>,
    any_hit: Option<&'a str>,
    closest_hit: Option<&'a str>,
}

impl<'a> HitGroup<'a> {
    /// A group for triangles, which the device intersects itself.
    pub fn triangles() -> Self {
        Self::default()
    }

    /// A group for boxes, inside which `shader` reports hits.
    pub fn procedural(shader: &'a str) -> Self {
        Self { intersection: Some(shader), ..Self::default() }
    }

    /// Adds the shader that runs once, at the hit nearest to the ray's origin.
    pub fn closest_hit(self, shader: &'a str) -> Self {
        Self { closest_hit: Some(shader), ..self }
    }

    /// Adds the shader that runs at each hit of non-opaque geometry and may ignore it.
    pub fn any_hit(self, shader: &'a str) -> Self {
        Self { any_hit: Some(shader), ..self }
    }
}

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

/// A `VkPipeline` with its layout, freed on drop.
pub struct RayTracingPipeline {
    /// The Vulkan handle.
    pub handle: vk::Pipeline,
    /// The pipeline layout.
    pub layout: vk::PipelineLayout,
    /// The name it was given.
    pub name: String,
    /// How many groups there are of each kind: raygen, miss, hit, callable.
    pub groups: [usize; 4],
    /// The shader stages in use, by path below `shaders/`.
    pub stages: Vec<String>,
    /// What the driver was given of each: the words of its module.
    pub modules: Vec<Vec<u32>>,
    /// How long compiling the shaders and making the pipeline took.
    pub build_time: Duration,
    bindings: Vec<Binding>,
    push_size: usize,
    textures: Option<vk::DescriptorSet>,
    set_layout: vk::DescriptorSetLayout,
    gpu: Gpu,
}

impl RayTracingPipeline {
    /// An empty pipeline, to be filled line by line; its shaders lie in `shaders/{name}/`.
    pub fn builder(name: &str) -> PipelineBuilder<'_> {
        PipelineBuilder {
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
            self.name,
            self.bindings
        );
        let bytes = bytemuck::bytes_of(push);
        ensure!(
            bytes.len() == self.push_size,
            "pipeline '{}' takes {} bytes of push constants, not {}",
            self.name,
            self.push_size,
            bytes.len()
        );
        let point = vk::PipelineBindPoint::RAY_TRACING_KHR;
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
        let point = vk::PipelineBindPoint::RAY_TRACING_KHR;
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

/// The stages that a push constant or descriptor is visible in.
const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::RAYGEN_KHR.as_raw()
        | vk::ShaderStageFlags::MISS_KHR.as_raw()
        | vk::ShaderStageFlags::CLOSEST_HIT_KHR.as_raw()
        | vk::ShaderStageFlags::ANY_HIT_KHR.as_raw()
        | vk::ShaderStageFlags::INTERSECTION_KHR.as_raw()
        | vk::ShaderStageFlags::CALLABLE_KHR.as_raw(),
);

impl<'a> PipelineBuilder<'a> {
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

/// The shaders of a pipeline, each compiled once however many groups use it.
struct Stages<'a> {
    folder: &'a str,
    defines: &'a [(&'a str, String)],
    exact: bool,
    shaders: Vec<Shader>,
}

impl Stages<'_> {
    fn add(&mut self, file: &str) -> Result<u32> {
        let path = format!("{}/{file}", self.folder);
        let known = self.shaders.iter().position(|shader| shader.path == path);
        let index = match known {
            Some(index) => index,
            None => {
                let mut shader = shader::compile_with(&path, self.defines)?;
                if self.exact {
                    shader.spirv = exact(&shader.spirv)?;
                }
                self.shaders.push(shader);
                self.shaders.len() - 1
            }
        };
        Ok(index as u32)
    }

    fn hit_group(
        &mut self,
        hit: &HitGroup,
    ) -> Result<vk::RayTracingShaderGroupCreateInfoKHR<'static>> {
        let ty = match hit.intersection {
            Some(_) => vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP,
            None => vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP,
        };
        let mut stage =
            |path: Option<&str>| path.map_or(Ok(vk::SHADER_UNUSED_KHR), |p| self.add(p));
        Ok(vk::RayTracingShaderGroupCreateInfoKHR::default()
            .ty(ty)
            .general_shader(vk::SHADER_UNUSED_KHR)
            .intersection_shader(stage(hit.intersection)?)
            .any_hit_shader(stage(hit.any_hit)?)
            .closest_hit_shader(stage(hit.closest_hit)?))
    }
}

fn general(stage: u32) -> vk::RayTracingShaderGroupCreateInfoKHR<'static> {
    vk::RayTracingShaderGroupCreateInfoKHR::default()
        .ty(vk::RayTracingShaderGroupTypeKHR::GENERAL)
        .general_shader(stage)
        .closest_hit_shader(vk::SHADER_UNUSED_KHR)
        .any_hit_shader(vk::SHADER_UNUSED_KHR)
        .intersection_shader(vk::SHADER_UNUSED_KHR)
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

impl Drop for RayTracingPipeline {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe {
            self.gpu.device.destroy_pipeline(self.handle, None);
            self.gpu.device.destroy_pipeline_layout(self.layout, None);
            self.gpu.device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}
