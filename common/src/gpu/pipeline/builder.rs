//! A pipeline put together line by line.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use ash::vk;

use super::hit_group::HitGroup;
use super::{Binding, ComputePipeline, GraphicsPipeline, Pipeline, RayTracingPipeline};
use crate::gpu::agreement;
use crate::gpu::blueprint::{Attachments, Blueprint, Group, Stage};
use crate::gpu::enumeration::ShaderConstant;
use crate::gpu::layout::{Known, ShaderStruct, StructLayout};
use crate::gpu::shader::{Shader, StageText};
use crate::gpu::texture::TextureTable;
use crate::gpu::{Executable, Gpu};

/// Collects what a pipeline is made of. Begin with [`RayTracingPipeline::builder`],
/// [`ComputePipeline::builder`] or [`GraphicsPipeline::builder`].
pub struct PipelineBuilder<'a> {
    name: &'a str,
    raygen: Vec<&'a str>,
    miss: Vec<&'a str>,
    hit: Vec<HitGroup<'a>>,
    callable: Vec<&'a str>,
    compute: Option<&'a str>,
    workgroup: [u32; 2],
    raster: Vec<&'a str>,
    attachments: Attachments,
    bindings: Vec<Binding>,
    textures: Option<&'a TextureTable>,
    push: Option<StructLayout>,
    known: Known,
    constants: Vec<(u32, u32)>,
    defines: Vec<(&'a str, String)>,
    recursion: u32,
    flags: vk::PipelineCreateFlags,
    as_written: bool,
}

impl<'a> PipelineBuilder<'a> {
    pub(super) fn new(name: &'a str) -> Self {
        Self {
            name,
            raygen: Vec::new(),
            miss: Vec::new(),
            hit: Vec::new(),
            callable: Vec::new(),
            compute: None,
            workgroup: [1, 1],
            raster: Vec::new(),
            attachments: Attachments::default(),
            bindings: Vec::new(),
            textures: None,
            push: None,
            known: Known::default(),
            constants: Vec::new(),
            defines: Vec::new(),
            recursion: 1,
            flags: vk::PipelineCreateFlags::empty(),
            as_written: false,
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

    /// Sets the compute shader.
    pub fn compute(mut self, shader: &'a str) -> Self {
        self.compute = Some(shader);
        self
    }

    /// Sets width and height of a workgroup: the specialization constants `id` and `id + 1`, which the
    /// compute shader names as its `local_size_x_id` and `local_size_y_id`.
    pub fn workgroup(mut self, id: u32, size: [u32; 2]) -> Self {
        self.workgroup = size;
        self.constants.extend([(id, size[0]), (id + 1, size[1])]);
        self
    }

    /// Sets the vertex shader.
    pub fn vertex(mut self, shader: &'a str) -> Self {
        self.raster.insert(0, shader);
        self
    }

    /// Sets the fragment shader.
    pub fn fragment(mut self, shader: &'a str) -> Self {
        self.raster.push(shader);
        self
    }

    /// Adds the next colour attachment, which takes the place of what was there: nothing is blended.
    pub fn color(mut self, format: vk::Format) -> Self {
        self.attachments.colors.push(format.as_raw());
        self
    }

    /// Sets the depth attachment, and what a fragment's depth has to be against the one that is there.
    pub fn depth(mut self, format: vk::Format, compare: vk::CompareOp) -> Self {
        self.attachments.depth = Some((format.as_raw(), compare.as_raw()));
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
        T::reach(&mut self.known);
        self
    }

    /// Declares the data of hit records, checked against the `shaderRecordEXT` block of the same name.
    pub fn hit_data<T: ShaderStruct>(mut self) -> Self {
        T::reach(&mut self.known);
        self
    }

    /// Declares structures that shaders find by an address in other structures' memory.
    pub fn structs(mut self, layouts: &[StructLayout]) -> Self {
        layouts.iter().for_each(|layout| _ = self.known.add_struct(*layout));
        self
    }

    /// Sets the specialization constant `id` in every stage that has it. The names that shaders have for
    /// an enumeration's numbers are checked against it.
    pub fn constant<T: ShaderConstant>(mut self, id: u32, value: T) -> Self {
        self.constants.push((id, value.bits()));
        T::ENUM.into_iter().for_each(|layout| self.known.add_enum(layout));
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
    pub fn as_written(mut self) -> Self {
        self.as_written = true;
        self
    }

    /// Has 32-bit floats rounded to nearest even where the device can be told to, in shaders that ask for it
    /// by `#ifdef ROUNDING_MODE_RTE`.
    pub fn rounding_to_nearest_even(self, gpu: &Gpu) -> Self {
        match gpu.limits.rounding_to_nearest_even && gpu.emulation.rounds_to_nearest_even() {
            true => self.define("ROUNDING_MODE_RTE", 1),
            false => self,
        }
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
    /// If a shader does not compile, a structure or an enumeration differs between Rust and GLSL, Rust
    /// has not declared what lies at an address, the device allows less recursion, or there are more push
    /// constants than the sample's requirements say.
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
        let (mut shaders, mut groups) = (Vec::new(), Vec::new());
        let mut number = |file: &str| self.add(gpu, file, &mut shaders);
        for shader in self.raygen.iter().chain(&self.miss) {
            groups.push(Group::general(number(shader)?));
        }
        for hit in &self.hit {
            groups.push(hit.group(&mut number)?);
        }
        for shader in &self.callable {
            groups.push(Group::general(number(shader)?));
        }
        let count = [self.raygen.len(), self.miss.len(), self.hit.len(), self.callable.len()];
        let pipeline = self.make(gpu, start, shaders, groups, None)?;
        Ok(RayTracingPipeline { groups: count, pipeline })
    }

    /// Compiles the compute shader and makes the pipeline.
    ///
    /// # Errors
    /// As [`build`](Self::build); if there is no compute shader, or a workgroup is larger than the device
    /// takes.
    pub fn build_compute(self, gpu: &Gpu) -> Result<ComputePipeline> {
        let start = Instant::now();
        let workgroup @ [width, height] = self.workgroup;
        let limit = gpu.limits.max_compute_work_group_invocations;
        ensure!(
            width * height <= limit,
            "pipeline '{}' has workgroups of {width}x{height} invocations; {} takes {limit}",
            self.name,
            gpu.name
        );
        let shader = self.compute.context("a compute pipeline without a shader")?;
        let mut shaders = Vec::new();
        self.add(gpu, shader, &mut shaders)?;
        let pipeline = self.make(gpu, start, shaders, Vec::new(), None)?;
        Ok(ComputePipeline { workgroup, pipeline })
    }

    /// Compiles the vertex and the fragment shader and makes the pipeline.
    ///
    /// # Errors
    /// As [`build`](Self::build); if there is no vertex or no fragment shader.
    pub fn build_graphics(self, gpu: &Gpu) -> Result<GraphicsPipeline> {
        let start = Instant::now();
        let mut shaders = Vec::new();
        for shader in &self.raster {
            self.add(gpu, shader, &mut shaders)?;
        }
        let kinds: Vec<_> = shaders.iter().map(|shader| shader.stage).collect();
        ensure!(
            kinds == [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT],
            "pipeline '{}' has the stages {kinds:?}; a vertex and a fragment shader are right",
            self.name
        );
        let attachments = Some(self.attachments.clone());
        let pipeline = self.make(gpu, start, shaders, Vec::new(), attachments)?;
        Ok(GraphicsPipeline { pipeline })
    }

    /// The number of a stage among the pipeline's shaders: each is compiled once, however many groups have it.
    fn add(&self, gpu: &Gpu, file: &str, shaders: &mut Vec<Shader>) -> Result<u32> {
        let path = format!("{}/{file}", self.name);
        if let Some(known) = shaders.iter().position(|shader| shader.path == path) {
            return Ok(known as u32);
        }
        let (as_written, pipeline) = (self.as_written, self.number());
        shaders.push(Shader::of(&path, &self.defines, |stage| {
            gpu.emulation.words(&StageText { as_written, pipeline, ..stage })
        })?);
        Ok(shaders.len() as u32 - 1)
    }

    /// A number that pipelines share only if they are identical: made of the same stages and state.
    fn number(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.name, &self.raygen, &self.miss, &self.hit, &self.callable).hash(&mut hasher);
        (self.compute, self.workgroup, &self.raster).hash(&mut hasher);
        (&self.constants, &self.defines, self.recursion).hash(&mut hasher);
        (self.flags.as_raw(), self.as_written).hash(&mut hasher);
        hasher.finish()
    }

    /// The pipeline of these shaders; without groups and attachments it is a compute pipeline.
    fn make(
        &self,
        gpu: &Gpu,
        start: Instant,
        shaders: Vec<Shader>,
        groups: Vec<Group>,
        attachments: Option<Attachments>,
    ) -> Result<Pipeline> {
        let push_size = self.push.map_or(0, |push| push.size);
        let most = gpu.requirements.push_constants;
        ensure!(
            push_size <= most as usize,
            "pipeline '{}' has {push_size} bytes of push constants, and its sample asks for {most}: more \
             is to be said in requirements(), so that devices are chosen by it",
            self.name
        );
        let bindings = (self.bindings.len(), self.textures.is_some());
        agreement::check(self.name, &shaders, &self.known, bindings)?;
        let stage = |shader: Shader| Stage {
            path: shader.path,
            stage: shader.stage.as_raw(),
            words: shader.spirv,
        };
        let blueprint = Arc::new(Blueprint {
            name: self.name.to_owned(),
            stages: shaders.into_iter().map(stage).collect(),
            groups,
            attachments,
            constants: self.constants.clone(),
            bindings: self.bindings.iter().map(|kind| kind.descriptor_type().as_raw()).collect(),
            textures: self.textures.map(TextureTable::count),
            push_size: push_size as u32,
            recursion: self.recursion,
            flags: self.flags.as_raw(),
        });
        let mut pipeline = Pipeline {
            handle: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            build_time: Duration::ZERO,
            textures: self.textures.map(|table| table.set),
            set_layout: blueprint.set_layout(&gpu.device)?,
            bindings: self.bindings.clone(),
            blueprint,
            gpu: gpu.clone(),
        };
        let sets: Vec<_> = std::iter::once(pipeline.set_layout)
            .chain(self.textures.map(|table| table.layout))
            .collect();
        pipeline.layout = pipeline.blueprint.layout(&gpu.device, &sets)?;
        let flags = match gpu.executable_properties {
            Some(_) => vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR,
            None => vk::PipelineCreateFlags::empty(),
        };
        let name_module = |module, path: &str| gpu.name_object(module, path);
        pipeline.handle = pipeline
            .blueprint
            .create(
                &gpu.device,
                &gpu.ray_tracing_pipeline,
                pipeline.layout,
                gpu.pipeline_cache.handle,
                flags,
                name_module,
            )
            .with_context(|| format!("cannot make the pipeline '{}'", self.name))?;
        gpu.name_object(pipeline.handle, self.name);
        gpu.name_object(pipeline.layout, self.name);
        pipeline.build_time = start.elapsed();
        let executables = match &gpu.executable_properties {
            Some(device) => Executable::all(device, pipeline.handle)?,
            None => Vec::new(),
        };
        gpu.count(|statistics| {
            let Blueprint { stages, groups, .. } = &*pipeline.blueprint;
            statistics.pipeline_time += pipeline.build_time;
            statistics.stages.extend(stages.iter().map(|stage| stage.path.clone()));
            statistics.groups += groups.len();
            statistics.blueprints.push(pipeline.blueprint.clone());
            statistics.executables = executables;
        });
        Ok(pipeline)
    }
}
