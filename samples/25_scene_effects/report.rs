//! Report of the chapter: the effects with their reasons and costs, and the compiled shaders.

use anyhow::Result;
use common::Variant;
use common::gpu::{Pipeline, Reflection, Stage};
use effects::Finding;
use serde_json::{Value, json};

use crate::clock;
use crate::contents::Contents;
use crate::recipe::Recipe;
use crate::scenes::SCENES;
use crate::{Costs, Demo};

/// The report of a run.
///
/// # Errors
/// If a module is none.
pub fn report(demo: &Demo) -> Result<Value> {
    let costs = demo.costs.as_ref().map(Costs::all).unwrap_or_default();
    let found = demo.findings();
    let effects = found.iter().map(|Finding { effect, needed, why }| {
        let cost = costs.iter().find(|cost| cost.effect == *effect);
        json!({
            "name": effect.name(),
            "in": needed,
            "why": why,
            "cost_milliseconds": cost.map(|cost| cost.milliseconds),
            "time_without": cost.map(|cost| cost.ratio),
        })
    });
    let divergence = demo.recipe().divergence();
    let reordering = json!({
        "in": demo.can_reorder && divergence.is_ok(),
        "divergent": divergence.is_ok(),
        "why": divergence.unwrap_or_else(str::to_owned),
        "offered": demo.can_reorder,
    });
    Ok(json!({
        "reordering": reordering,
        "scene": SCENES[demo.number as usize],
        "effects": effects.collect::<Vec<_>>(),
        "ticks": demo.ticks.as_ref().map(clock::report).transpose()?,
        "pipeline": demo.pipelines.current().map(compiled).transpose()?,
    }))
}

/// The compiled shaders, from the very words passed to the driver.
fn compiled(variant: &Variant<Recipe>) -> Result<Value> {
    let Variant { key: recipe, pipeline, sbt } = variant;
    let Pipeline { desc, build_time, .. } = &**pipeline;
    let groups = pipeline.groups;
    let stages = desc.stages.iter().map(|Stage { path, words, .. }| {
        let contents = serde_json::to_value(Contents::of(&Reflection::of(words)?))?;
        Ok(json!({ "path": path, "words": words.len(), "module": contents }))
    });
    Ok(json!({
        "effects": recipe.effects.names(),
        "stages": stages.collect::<Result<Vec<_>>>()?,
        "groups": { "raygen": groups[0], "miss": groups[1], "hit": groups[2] },
        "sbt_bytes": sbt.layout.size,
        "recursion": desc.recursion,
        "cull_mask": recipe.mask(),
        "light_kinds": recipe.light_kinds,
        "lights": recipe.lights,
        "build_milliseconds": build_time.as_secs_f64() * 1e3,
    }))
}
