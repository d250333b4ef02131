//! The same paths by recursion: hit shaders trace the rays. Only this chapter has it, to compare.

use anyhow::Result;
use common::Controls;
use common::gpu::{Binding, Gpu, HitGroup, RayTracingPipeline, TextureTable};

use super::{Constants, MAX_DEPTH, Push};

common::shader_enum! {
    /// The way to trace a path: a loop, or hits by recursion.
    enum Method { Iterative, Recursive }
}

/// The method that traces paths, and the maximum number of reflections by recursion.
pub struct Recursion {
    method: Method,
    /// Maximum number of reflections of a path by recursion on this device.
    deepest: u32,
}

impl Recursion {
    /// A loop; what recursion could do follows from the device.
    pub fn new(gpu: &Gpu) -> Self {
        let deepest = MAX_DEPTH.min(gpu.limits.max_ray_recursion_depth.saturating_sub(2));
        Self { method: Method::Iterative, deepest }
    }

    /// Declares what may be set; returns how often a path may be reflected.
    pub fn controls(&mut self, c: &mut Controls) -> u32 {
        c.choice("method", &mut self.method);
        if self.method == Method::Recursive { self.deepest } else { MAX_DEPTH }
    }

    /// The value of [`Constants::recursive`] for paths of this depth.
    pub fn nested(&self, depth: u32) -> Option<u32> {
        (self.method == Method::Recursive).then_some(depth)
    }
}

/// The method decides which shaders there are, and how deep their rays nest.
pub fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    let Some(depth) = constants.recursive else {
        return super::pipeline(gpu, textures, constants);
    };
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("reflection_by_recursion/recursive.rgen")
        .miss("reflection_by_recursion/recursive.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("reflection_by_recursion/recursive.rchit"))
        .constant(0, constants.show)
        // The camera's ray and every reflection are a level each, and so is the last hit's shadow ray.
        .recursion(1 + depth + 1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
