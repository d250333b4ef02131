//! A GPU's own compiler without the GPU: Mesa's RADV or ANV on an emulated card.
//!
//! Mesa's `drm-shim` replaces the kernel's driver: preloaded, it shows RADV a card of the family named by
//! `AMDGPU_GPU_ID`, or ANV one named by `INTEL_STUB_GPU_PLATFORM`, with all its features. Submitted work is never
//! executed. Mesa before 26 has another way for compiling only: with `RADV_FORCE_FAMILY` RADV shows "Null hardware" of
//! that family, without memory or images.

use anyhow::{Context, Result, ensure};
use ash::vk;
use serde::{Deserialize, Serialize};

use common::gpu::{
    Executable, Gpu, GpuOptions, PipelineDesc, Requirements, TextureTable, Vulkan, device,
};

use super::family::Maker;

/// The result from the driver of a card that is not installed.
#[derive(Serialize, Deserialize)]
pub struct Answer {
    /// The driver's name and version.
    pub compiler: String,
    /// The programs of each pipeline.
    pub pipelines: Vec<Vec<Executable>>,
}

/// The compiler's statistics for each pipeline, for a family by Mesa's name; `None` if there is no such card.
///
/// Call it in a separate process whose environment provides the card: it may crash, and may hide the installed
/// cards. Mesa caches compiled pipelines with their statistics for the next time.
///
/// # Errors
/// If the card lacks something the sample needs, or its compiler refuses.
pub fn compile(
    requirements: &Requirements,
    family: &str,
    descs: &[PipelineDesc],
) -> Result<Option<Answer>> {
    let requirements = requirements.clone().compiler_figures_where_offered();
    let vulkan = Vulkan::new(None, None)?;
    let maker = Maker::of(family);
    let mut found = device::candidates(&vulkan.instance, &requirements)?.into_iter();
    let Some(card) = found.find(|candidate| maker.is(family, &candidate.name)) else {
        return Ok(None);
    };
    ensure!(card.missing.is_empty(), "it lacks {}", card.missing.join(", "));
    let gpu = Gpu::open(vulkan, card, GpuOptions { requirements, ..GpuOptions::default() })?;
    let pipelines: Result<_> = descs.iter().map(|desc| one(&gpu, desc)).collect();
    let compiler = gpu.driver.clone();
    // "Null hardware" crashes when its queue is waited for: the process frees the device.
    std::mem::forget(gpu);
    Ok(Some(Answer { compiler, pipelines: pipelines? }))
}

fn one(gpu: &Gpu, desc: &PipelineDesc) -> Result<Vec<Executable>> {
    let properties =
        gpu.executable_properties.as_ref().context("its driver reports no statistics")?;
    let textures = desc.textures.map(|count| TextureTable::layout(gpu, count)).transpose()?;
    let (set, layout) = desc.layouts(gpu, textures)?;
    let mut desc = desc.clone();
    desc.flags |= vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR.as_raw();
    let made = desc.create(gpu, layout, vk::PipelineCache::null());
    let made = made.with_context(|| format!("cannot make the pipeline '{}'", desc.name));
    let executables = made.and_then(|pipeline| {
        let executables = Executable::all(properties, pipeline);
        // SAFETY: nothing uses it.
        unsafe { gpu.device.destroy_pipeline(pipeline, None) };
        executables
    });
    // SAFETY: the pipeline is gone.
    unsafe {
        gpu.device.destroy_pipeline_layout(layout, None);
        for set in [set].into_iter().chain(textures) {
            gpu.device.destroy_descriptor_set_layout(set, None);
        }
    }
    executables
}
