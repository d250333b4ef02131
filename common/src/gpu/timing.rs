//! Timing of the device: by its own clock, or by the host's if the queue has no timestamps.

use std::cell::Cell;
use std::time::Instant;

use anyhow::Result;
use ash::vk;

use super::Gpu;
use super::queries::Queries;

/// A pair of timestamps around recorded commands.
///
/// A queue without valid timestamp bits may not write any (Vulkan specification, `vkCmdWriteTimestamp2`). In that
/// case the host's clock runs from the recording until the time is read.
pub struct Timer {
    stamps: Queries,
    started: Cell<Instant>,
    gpu: Gpu,
}

impl Timer {
    /// A timer for one command buffer at a time.
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let stamps = Queries::new(gpu, vk::QueryType::TIMESTAMP, 2)?;
        Ok(Self { stamps, started: Cell::new(Instant::now()), gpu: gpu.clone() })
    }

    /// Starts the clock when all earlier commands are done.
    pub fn start(&self, cmd: vk::CommandBuffer) {
        self.started.set(Instant::now());
        if self.gpu.limits.has_timestamps() {
            self.stamps.reset(cmd);
            self.stamp(cmd, 0);
        }
    }

    /// Stops it when the commands recorded since are done.
    pub fn stop(&self, cmd: vk::CommandBuffer) {
        if self.gpu.limits.has_timestamps() {
            self.stamp(cmd, 1);
        }
    }

    fn stamp(&self, cmd: vk::CommandBuffer, query: u32) {
        let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
        // SAFETY: cmd is being recorded, and the queries are alive until its submission is done.
        unsafe { self.gpu.device.cmd_write_timestamp2(cmd, stage, self.stamps.handle, query) };
    }

    /// Milliseconds between start and stop; call it as soon as the commands are done.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn milliseconds(&self) -> Result<f64> {
        if !self.gpu.limits.has_timestamps() {
            return Ok(self.started.get().elapsed().as_secs_f64() * 1e3);
        }
        let stamps = self.stamps.results()?;
        // Some queues have fewer than 64 valid bits and wrap around.
        let limits = &self.gpu.limits;
        let ticks = stamps[1].wrapping_sub(stamps[0]) & u64::MAX >> (64 - limits.timestamp_bits);
        Ok(ticks as f64 * f64::from(limits.core.timestamp_period) * 1e-6)
    }
}
