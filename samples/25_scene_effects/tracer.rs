//! A pipeline with its shader binding table and top level, and how it is made without keeping anyone
//! waiting.

use std::sync::Arc;
use std::thread::JoinHandle;

use anyhow::{Result, anyhow};
use common::gpu::{
    AccelerationStructure, Gpu, RayTracingPipeline, Reflection, ShaderBindingTable, Stage,
    TextureTable,
};
use serde_json::{Value, json};

use crate::geometry::SceneGeometry;
use crate::recipe::Recipe;

/// All that a trace needs but the world.
pub struct Tracer {
    /// What it was made for.
    pub recipe: Recipe,
    /// The pipeline.
    pub pipeline: RayTracingPipeline,
    /// Its table: a record for each group.
    pub sbt: ShaderBindingTable,
    /// Its instances name the table's records.
    pub tlas: AccelerationStructure,
}

impl Tracer {
    /// Table and top level for a pipeline.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(
        gpu: &Gpu,
        geometry: &SceneGeometry,
        recipe: Recipe,
        pipeline: RayTracingPipeline,
    ) -> Result<Self> {
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let tlas = geometry.top_level(gpu, &recipe)?;
        Ok(Self { recipe, pipeline, sbt, tlas })
    }

    // ANCHOR: report
    /// What was compiled, from the very words that the driver got.
    ///
    /// # Errors
    /// If a module is none.
    pub fn report(&self) -> Result<Value> {
        let RayTracingPipeline { blueprint, groups, build_time, .. } = &self.pipeline;
        let stages = blueprint.stages.iter().map(|Stage { path, words, .. }| {
            let contents = serde_json::to_value(Reflection::of(words)?.contents())?;
            Ok(json!({ "path": path, "words": words.len(), "module": contents }))
        });
        Ok(json!({
            "effects": self.recipe.effects.names(),
            "stages": stages.collect::<Result<Vec<_>>>()?,
            "groups": { "raygen": groups[0], "miss": groups[1], "hit": groups[2] },
            "sbt_bytes": self.sbt.layout.size,
            "recursion": self.recipe.recursion(),
            "cull_mask": self.recipe.mask(),
            "light_kinds": self.recipe.light_kinds,
            "lights": self.recipe.lights,
            "build_milliseconds": build_time.as_secs_f64() * 1e3,
        }))
    }
    // ANCHOR_END: report
}

/// Where pipelines are made: at once, or by another thread while the old one renders.
#[derive(Default)]
pub struct Workshop {
    order: Option<(Recipe, JoinHandle<Result<RayTracingPipeline>>)>,
}

impl Workshop {
    /// Whether a pipeline is being made.
    pub fn is_busy(&self) -> bool {
        self.order.is_some()
    }

    // ANCHOR: background
    /// Begins a pipeline, if none is being made.
    pub fn begin(&mut self, gpu: &Gpu, textures: &Arc<TextureTable>, recipe: Recipe) {
        if self.order.is_none() {
            let (gpu, textures) = (gpu.clone(), textures.clone());
            let thread = std::thread::spawn(move || recipe.build(&gpu, &textures));
            self.order = Some((recipe, thread));
        }
    }

    /// The pipeline that was begun, once it is made; or why it cannot be.
    pub fn done(&mut self) -> Option<(Recipe, Result<RayTracingPipeline>)> {
        let (recipe, thread) = self.order.take_if(|(_, thread)| thread.is_finished())?;
        let made = thread.join().unwrap_or_else(|_| Err(anyhow!("making a pipeline panicked")));
        Some((recipe, made))
    }
    // ANCHOR_END: background
}

impl Drop for Workshop {
    fn drop(&mut self) {
        // What is half made must not outlive the window.
        if let Some((_, thread)) = self.order.take() {
            let _ = thread.join();
        }
    }
}
