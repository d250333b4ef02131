//! The view `show=time`: the ticks of the device's clock that each pixel takes.

use anyhow::Result;
use ash::vk;
use common::UsageError;
use common::app::Args;
use common::gpu::{Buffer, Gpu};
use common::scene::input_usage;
use serde_json::{Value, json};

/// The value of the control `show`.
pub const TIME: u32 = 1;

/// Returns whether shaders of the device can read a clock.
pub fn has_clock(gpu: &Gpu) -> bool {
    gpu.features.clock.shader_subgroup_clock == vk::TRUE
}

/// Refuses a picture of times, which would differ from run to run.
///
/// # Errors
/// If one is requested.
pub fn check(args: &Args) -> Result<(), UsageError> {
    let is_shown = args.sets.iter().any(|(name, value)| name == "show" && value == "time");
    if is_shown && (args.out.is_some() || args.animate) {
        let line = "show=time differs from run to run, so it is not written to a picture; see it in the window, or \
                    its numbers by --report";
        return Err(UsageError(line.to_owned()));
    }
    Ok(())
}

/// The ticks of each pixel, as a `u32`.
pub fn ticks(gpu: &Gpu, extent: vk::Extent2D) -> Result<Buffer> {
    let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_SRC;
    let size = u64::from(extent.width) * u64::from(extent.height) * 4;
    Buffer::new(gpu, "ticks", size, usage)
}

/// Quantiles of the ticks.
///
/// # Errors
/// If the device fails.
pub fn report(ticks: &Buffer) -> Result<Value> {
    let mut all = ticks.read::<u32>()?;
    all.sort_unstable();
    let at = |part: f64| all.get((part * all.len().saturating_sub(1) as f64) as usize).copied();
    Ok(json!({ "least": at(0.0), "median": at(0.5), "p99": at(0.99), "most": at(1.0) }))
}
