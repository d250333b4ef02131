//! A GPU's compiler without the GPU: Mesa's RADV on a device that is not there.
//!
//! With `RADV_FORCE_FAMILY` in the environment RADV shows a "Null hardware" device of that family. Nothing
//! runs on it, and it has neither memory nor images; but it compiles pipelines, and tells what it made.

use anyhow::{Context, Result, ensure};
use ash::{Device, khr, vk};
use serde::{Deserialize, Serialize};

use super::blueprint::Blueprint;
use super::instance;
use super::requirements::Requirements;
use super::{Executable, TextureTable, device, load};

/// What a null device's driver has to say.
#[derive(Serialize, Deserialize)]
pub struct Answer {
    /// The driver's name and version.
    pub compiler: String,
    /// The programs of each pipeline.
    pub pipelines: Vec<Vec<Executable>>,
}

/// What the null device makes of each pipeline.
///
/// To be called in a process of its own, whose environment has `RADV_FORCE_FAMILY`: the variable hides
/// every AMD GPU that is there.
///
/// # Errors
/// If there is no such device, if it lacks what the sample needs, or if its compiler refuses.
pub fn compile(requirements: &Requirements, blueprints: &[Blueprint]) -> Result<Answer> {
    let requirements = requirements.clone().compiler_figures_where_offered();
    let entry = load()?;
    let (instance, _) = instance::create(&entry, None, None)?;
    let result = (|| {
        let found = device::candidates(&instance, &requirements)?;
        let null = found.into_iter().find(|candidate| candidate.name.starts_with("Null hardware"));
        let null = null.context("Mesa's RADV shows no null device")?;
        ensure!(null.missing.is_empty(), "it lacks {}", null.missing.join(", "));
        let device = device::create(&instance, &null, &requirements)?;
        let ray_tracing_pipeline = khr::ray_tracing_pipeline::Device::new(&instance, &device);
        let properties = khr::pipeline_executable_properties::Device::new(&instance, &device);
        let pipelines: Result<_> = blueprints
            .iter()
            .map(|blueprint| one(&device, &ray_tracing_pipeline, &properties, blueprint))
            .collect();
        // SAFETY: nothing made from the device is left.
        unsafe { device.destroy_device(None) };
        Ok(Answer { compiler: null.driver, pipelines: pipelines? })
    })();
    // SAFETY: nothing made from the instance is left.
    unsafe { instance.destroy_instance(None) };
    result
}

fn one(
    device: &Device,
    ray_tracing_pipeline: &khr::ray_tracing_pipeline::Device,
    properties: &khr::pipeline_executable_properties::Device,
    blueprint: &Blueprint,
) -> Result<Vec<Executable>> {
    let mut sets = vec![blueprint.set_layout(device)?];
    let result = (|| {
        if let Some(count) = blueprint.textures {
            sets.push(TextureTable::layout(device, count)?);
        }
        let layout = blueprint.layout(device, &sets)?;
        let flags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;
        let cache = vk::PipelineCache::null();
        let made = blueprint.create(device, ray_tracing_pipeline, layout, cache, flags, |_, _| {});
        let made = made.with_context(|| format!("cannot make the pipeline '{}'", blueprint.name));
        let executables = made.and_then(|pipeline| {
            let executables = Executable::all(properties, pipeline);
            // SAFETY: nothing uses it.
            unsafe { device.destroy_pipeline(pipeline, None) };
            executables
        });
        // SAFETY: its pipeline is gone.
        unsafe { device.destroy_pipeline_layout(layout, None) };
        executables
    })();
    for set in sets {
        // SAFETY: the pipeline layout is gone.
        unsafe { device.destroy_descriptor_set_layout(set, None) };
    }
    result
}
