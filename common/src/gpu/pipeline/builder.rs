//! Builds a pipeline line by line.

use std::sync::Arc;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use ash::vk;

use super::hit_group::HitGroup;
use super::{ComputePipeline, GraphicsPipeline, Pipeline, RayTracingPipeline};
use crate::gpu::check::interface_check;
use crate::gpu::memory::texture::TextureTable;
use crate::gpu::pipeline::desc::{Binding, Group, PipelineDesc, Stage};
use crate::gpu::pipeline::enumeration::ShaderConstant;
use crate::gpu::pipeline::layout::{Known, ShaderStruct, StructLayout};
use crate::gpu::pipeline::shader::{self, Shader, StageText};
use crate::gpu::{Executable, Gpu};

/// Fills a [`PipelineDesc`] line by line. Begin with [`RayTracingPipeline::builder`],
/// [`ComputePipeline::builder`] or [`GraphicsPipeline::builder`].
#[derive(Default)]
pub struct PipelineBuilder<'a> {
    /// The description of the pipeline; the SPIR-V of its stages is added last.
    desc: PipelineDesc,
    /// Number of groups of each kind: raygen, miss, hit, callable.
    groups: [usize; 4],
    workgroup: [u32; 2],
    textures: Option<&'a TextureTable>,
    known: Known,
    defines: Vec<(&'a str, String)>,
    as_written: bool,
}

impl<'a> PipelineBuilder<'a> {
    pub(super) fn new(name: &str) -> Self {
        let desc = PipelineDesc { name: name.to_owned(), recursion: 1, ..PipelineDesc::default() };
        Self { desc, workgroup: [1, 1], ..Self::default() }
    }

    /// Adds a ray generation shader; `vkCmdTraceRaysKHR` starts the first.
    pub fn raygen(self, shader: &str) -> Self {
        self.general(0, shader)
    }

    /// Adds a miss shader; `traceRayEXT` selects it by position.
    pub fn miss(self, shader: &str) -> Self {
        self.general(1, shader)
    }

    /// Adds a hit group.
    pub fn hit(mut self, group: HitGroup) -> Self {
        let group = group.of_stages(|shader| self.stage(shader));
        self.group(2, group)
    }

    /// Adds a callable shader; `executeCallableEXT` selects it by position.
    pub fn callable(self, shader: &str) -> Self {
        self.general(3, shader)
    }

    /// Adds a group of one shader.
    fn general(mut self, kind: usize, shader: &str) -> Self {
        let general = self.stage(shader);
        self.group(kind, Group { general, ..Group::default() })
    }

    /// Adds a group after the others of its kind.
    fn group(mut self, kind: usize, group: Group) -> Self {
        let at = self.groups[..=kind].iter().sum();
        self.desc.groups.insert(at, group);
        self.groups[kind] += 1;
        self
    }

    /// The number of a stage: each is compiled once, however many groups use it. Its file is in the folder with
    /// the pipeline's name, or at the given path below `shaders/`.
    fn stage(&mut self, shader: &str) -> u32 {
        let PipelineDesc { name, stages, .. } = &mut self.desc;
        let path =
            if shader.contains('/') { shader.to_owned() } else { format!("{name}/{shader}") };
        if let Some(known) = stages.iter().position(|stage| stage.path == path) {
            return known as u32;
        }
        stages.push(Stage { path, ..Stage::default() });
        stages.len() as u32 - 1
    }

    /// Sets the compute shader.
    pub fn compute(mut self, shader: &str) -> Self {
        self.stage(shader);
        self
    }

    /// Sets width and height of a workgroup: the specialization constants `id` and `id + 1`, which the compute
    /// shader uses as its `local_size_x_id` and `local_size_y_id`.
    pub fn workgroup(mut self, id: u32, size: [u32; 2]) -> Self {
        self.workgroup = size;
        self.desc.constants.extend([[id, size[0]], [id + 1, size[1]]]);
        self
    }

    /// Sets the vertex shader.
    pub fn vertex(mut self, shader: &str) -> Self {
        self.stage(shader);
        self.desc.stages.rotate_right(1);
        self
    }

    /// Sets the fragment shader.
    pub fn fragment(mut self, shader: &str) -> Self {
        self.stage(shader);
        self
    }

    /// Adds the next colour attachment, without blending.
    pub fn color(mut self, format: vk::Format) -> Self {
        let attachments = self.desc.attachments.get_or_insert_default();
        attachments.colors.push(format.as_raw());
        self
    }

    /// Sets the depth attachment, and the comparison of a fragment's depth with the stored one.
    pub fn depth(mut self, format: vk::Format, compare: vk::CompareOp) -> Self {
        let attachments = self.desc.attachments.get_or_insert_default();
        attachments.depth = Some((format.as_raw(), compare.as_raw()));
        self
    }

    /// Adds the next binding of set 0.
    pub fn binding(mut self, binding: Binding) -> Self {
        self.desc.bindings.push(binding);
        self
    }

    /// Makes set 1 the texture table.
    pub fn textures(mut self, textures: &'a TextureTable) -> Self {
        self.desc.textures = Some(textures.count());
        self.textures = Some(textures);
        self
    }

    /// Declares the push constants, checked against the block of the same name in every shader.
    pub fn push_constants<T: ShaderStruct>(mut self) -> Self {
        self.desc.push_size = T::LAYOUT.size as u32;
        T::reach(&mut self.known);
        self
    }

    /// Declares the data of hit records, checked against the `shaderRecordEXT` block of the same name.
    pub fn hit_data<T: ShaderStruct>(mut self) -> Self {
        T::reach(&mut self.known);
        self
    }

    /// Declares structures that shaders reach by an address stored in another structure.
    pub fn structs(mut self, layouts: &[StructLayout]) -> Self {
        layouts.iter().for_each(|layout| _ = self.known.add_struct(*layout));
        self
    }

    /// Sets the specialization constant `id` in every stage that has it. For an enumeration, the names shaders use
    /// for its numbers are checked.
    pub fn constant<T: ShaderConstant>(mut self, id: u32, value: T) -> Self {
        self.desc.constants.push([id, value.bits()]);
        T::ENUM.into_iter().for_each(|layout| self.known.add_enum(layout));
        self
    }

    /// Defines a macro in every stage, for code that must not even be compiled.
    pub fn define(mut self, name: &'a str, value: impl ToString) -> Self {
        self.defines.push((name, value.to_string()));
        self
    }

    /// Sets the nesting depth of `traceRayEXT`: 1 is a ray from the raygen shader, 2 a ray from its hit.
    pub fn recursion(mut self, depth: u32) -> Self {
        self.desc.recursion = depth;
        self
    }

    /// Forbids the compiler to rearrange arithmetic, so that a result does not depend on what else is compiled with it.
    pub fn as_written(mut self) -> Self {
        self.as_written = true;
        self
    }

    /// Rounds 32-bit floats to nearest even where the device supports that, in shaders that opt in by `#ifdef
    /// ROUNDING_MODE_RTE`.
    pub fn rounding_to_nearest_even(self, gpu: &Gpu) -> Self {
        let can = gpu.limits.vulkan12.shader_rounding_mode_rte_float32 == vk::TRUE;
        if can && gpu.driver_shim.rounds_to_nearest_even() {
            self.define("ROUNDING_MODE_RTE", 1)
        } else {
            self
        }
    }

    /// Lets shaders that opt in by `#ifdef FMA_KHR` use the instruction `OpFmaKHR`, which rounds once, if the sample
    /// has asked for it by [`Requirements::fma_where_offered`](crate::gpu::Requirements::fma_where_offered) and the
    /// device offers it.
    pub fn fma_rounded_once(self, gpu: &Gpu) -> Self {
        if gpu.features.fma.shader_fma_float32 == vk::TRUE {
            self.define("FMA_KHR", 1)
        } else {
            self
        }
    }

    /// Lets shaders that opt in by `#ifdef INT64` use 64-bit integers, if the sample has asked for them by
    /// [`Requirements::int64_where_offered`](crate::gpu::Requirements::int64_where_offered) and the device supports them.
    pub fn int64(self, gpu: &Gpu) -> Self {
        if gpu.features.core.shader_int64 == vk::TRUE { self.define("INT64", 1) } else { self }
    }

    /// Promises that rays skip all triangles, or all boxes: requires `rayTraversalPrimitiveCulling`, and only one
    /// of the two.
    pub fn skip(mut self, flags: vk::PipelineCreateFlags) -> Self {
        self.desc.flags |= flags.as_raw();
        self
    }

    /// Lets rays hit triangles with opacity micromaps: requires the feature `micromap`.
    pub fn opacity_micromaps(mut self, meets: bool) -> Self {
        if meets {
            let flag = vk::PipelineCreateFlags::RAY_TRACING_OPACITY_MICROMAP_EXT;
            self.desc.flags |= flag.as_raw();
        }
        self
    }

    /// Compiles the shaders and creates the pipeline.
    ///
    /// # Errors
    /// If a shader does not compile, a structure or an enumeration differs between Rust and GLSL, Rust has not
    /// declared the structure at an address, the device allows less recursion, or there are more push constants
    /// than the sample's requirements state.
    pub fn build(self, gpu: &Gpu) -> Result<RayTracingPipeline> {
        let PipelineDesc { name, recursion, .. } = &self.desc;
        let limit = gpu.limits.max_ray_recursion_depth;
        ensure!(
            *recursion <= limit,
            "pipeline '{name}' needs a recursion depth of {recursion}; {} allows {limit}",
            gpu.name
        );
        ensure!(
            self.groups[0] > 0,
            "pipeline '{name}' has no ray generation shader: the line .raygen(\"camera.rgen\") adds one"
        );
        Ok(RayTracingPipeline {
            groups: self.groups,
            hit_records: Mutex::default(),
            pipeline: self.pipeline(gpu)?,
        })
    }

    /// Compiles the compute shader and creates the pipeline.
    ///
    /// # Errors
    /// As [`build`](Self::build); if there is no compute shader, or a workgroup exceeds the device's limit.
    pub fn build_compute(self, gpu: &Gpu) -> Result<ComputePipeline> {
        let (name, workgroup @ [width, height]) = (&self.desc.name, self.workgroup);
        let limit = gpu.limits.core.max_compute_work_group_invocations;
        ensure!(
            width * height <= limit,
            "pipeline '{name}' has workgroups of {width}x{height} invocations; {} takes {limit}",
            gpu.name
        );
        ensure!(!self.desc.stages.is_empty(), "a compute pipeline without a shader");
        Ok(ComputePipeline { workgroup, pipeline: self.pipeline(gpu)? })
    }

    /// Compiles the vertex and the fragment shader and creates the pipeline.
    ///
    /// # Errors
    /// As [`build`](Self::build); if there is no vertex or no fragment shader.
    pub fn build_graphics(mut self, gpu: &Gpu) -> Result<GraphicsPipeline> {
        let PipelineDesc { name, stages, attachments, .. } = &mut self.desc;
        let kinds = stages.iter().map(|stage| shader::stage(&stage.path));
        let kinds: Vec<_> = kinds.collect::<Result<_>>()?;
        ensure!(
            kinds == [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT],
            "pipeline '{name}' has the stages {kinds:?}; a vertex and a fragment shader are right"
        );
        attachments.get_or_insert_default();
        Ok(GraphicsPipeline { pipeline: self.pipeline(gpu)? })
    }

    /// Compiles each stage and creates the pipeline.
    fn pipeline(self, gpu: &Gpu) -> Result<Pipeline> {
        let start = Instant::now();
        let Self { mut desc, groups, textures, known, defines, as_written, .. } = self;
        let mut shaders = Vec::new();
        for Stage { path, .. } in &desc.stages {
            shaders.push(Shader::of(path, &defines, |stage| {
                let pipeline = Some(&desc);
                gpu.driver_shim.words(&StageText { as_written, pipeline, ..stage })
            })?);
        }
        let (push_size, most) = (desc.push_size, gpu.requirements.push_constants);
        ensure!(
            push_size <= most,
            "pipeline '{}' has {push_size} bytes of push constants, and its sample asks for {most}: more \
             is to be said in requirements(), so that devices are chosen by it",
            desc.name
        );
        ensure!(
            textures.is_none() || gpu.features.vulkan12.runtime_descriptor_array == vk::TRUE,
            "pipeline '{}' has a texture table, and its sample does not ask for one: requirements() takes \
             .textures()",
            desc.name
        );
        let mut agreed = interface_check::check(&desc, groups, &shaders, &known)?;
        gpu.warn(&desc.name, std::mem::take(&mut agreed.warnings));
        for (stage, shader) in desc.stages.iter_mut().zip(shaders) {
            (stage.stage, stage.words) = (shader.stage.as_raw(), shader.spirv);
        }
        if gpu.executable_properties.is_some() {
            desc.flags |= vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR.as_raw();
        }
        let (set_layout, layout) = desc.layouts(gpu, textures.map(|table| table.layout))?;
        let mut pipeline = Pipeline {
            handle: vk::Pipeline::null(),
            layout,
            set_layout,
            textures: textures.map(|table| table.set),
            agreed,
            desc: Arc::new(desc),
            build_time: Duration::ZERO,
            gpu: gpu.clone(),
        };
        let desc = pipeline.desc.clone();
        let cannot = || format!("cannot make the pipeline '{}'", desc.name);
        let made = desc.create(gpu, layout, gpu.pipeline_cache.handle);
        pipeline.handle = made.with_context(cannot)?;
        gpu.name_object(pipeline.handle, &desc.name);
        gpu.name_object(layout, &desc.name);
        gpu.name_object(set_layout, &desc.name);
        pipeline.build_time = start.elapsed();
        if let Some(device) = &gpu.executable_properties {
            // The pipeline is usable even if the driver reports no statistics.
            let executables = Executable::all(device, pipeline.handle).unwrap_or_else(|error| {
                let line = format!("{} reports no compiler statistics: {error}", gpu.name);
                gpu.warn(&desc.name, vec![line]);
                Vec::new()
            });
            gpu.count(|statistics| statistics.executables = executables);
        }
        gpu.count(|statistics| {
            statistics.pipeline_time += pipeline.build_time;
            statistics.descs.push(desc);
        });
        Ok(pipeline)
    }
}
