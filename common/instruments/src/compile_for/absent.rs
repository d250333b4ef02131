//! A GPU's own compiler without the GPU: Mesa's RADV on a card that is not there.
//!
//! Mesa's `drm-shim` takes the place of the kernel's driver: preloaded, it shows RADV a card of whatever family
//! `AMDGPU_GPU_ID` names, with all that such a card has. What is submitted to it is never executed. Mesa before
//! 26 has another way for compilers alone: with `RADV_FORCE_FAMILY` RADV shows "Null hardware" of that family,
//! without memory or images.

use anyhow::{Context, Result, ensure};
use ash::{Device, khr, vk};
use serde::{Deserialize, Serialize};

use common::gpu::{Blueprint, Executable, Requirements, TextureTable, device, instance};

/// What an absent card's driver has to say.
#[derive(Serialize, Deserialize)]
pub struct Answer {
    /// The driver's name and version.
    pub compiler: String,
    /// The programs of each pipeline.
    pub pipelines: Vec<Vec<Executable>>,
}

/// What RADV makes of each pipeline for a family, by RADV's name for it; `None` if there is no such card.
///
/// To be called in a process of its own, whose environment brings the card: it may crash, and may hide the
/// cards that are there. Mesa keeps what it has compiled, with its figures, for the next time.
///
/// # Errors
/// If the card lacks what the sample needs, or if its compiler refuses.
pub fn compile(
    requirements: &Requirements,
    family: &str,
    blueprints: &[Blueprint],
) -> Result<Option<Answer>> {
    let requirements = requirements.clone().compiler_figures_where_offered();
    let entry = instance::load()?;
    let (instance, _) = instance::create(&entry, None, None)?;
    let result = (|| {
        // Such as "AMD Radeon RX 7900 XTX (RADV NAVI31)", or "Null hardware (RADV NAVI31)".
        let name = format!("(RADV {})", family.to_uppercase());
        let mut found = device::candidates(&instance, &requirements)?.into_iter();
        let Some(card) = found.find(|candidate| candidate.name.ends_with(&name)) else {
            return Ok(None);
        };
        ensure!(card.missing.is_empty(), "it lacks {}", card.missing.join(", "));
        let device = device::create(&instance, &card)?;
        let ray_tracing_pipeline = khr::ray_tracing_pipeline::Device::new(&instance, &device);
        let properties = khr::pipeline_executable_properties::Device::new(&instance, &device);
        let pipelines: Result<_> = blueprints
            .iter()
            .map(|blueprint| one(&device, &ray_tracing_pipeline, &properties, blueprint))
            .collect();
        // SAFETY: nothing made from the device is left.
        unsafe { device.destroy_device(None) };
        Ok(Some(Answer { compiler: card.driver, pipelines: pipelines? }))
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
        let mut blueprint = blueprint.clone();
        blueprint.flags |= vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR.as_raw();
        let cache = vk::PipelineCache::null();
        let made = blueprint.create(device, ray_tracing_pipeline, layout, cache, |_, _| {});
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
