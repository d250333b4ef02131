//! How long the device worked: by its own clock, or by the host's where the queue has none.

use std::cell::Cell;
use std::time::Instant;

use anyhow::Result;
use ash::vk;

use super::Gpu;

/// A pair of timestamps around recorded commands.
///
/// A queue whose timestamps have no valid bits may not write any (Vulkan specification,
/// `vkCmdWriteTimestamp2`). There the host's clock runs from the recording until someone asks.
pub struct Timer {
    pool: vk::QueryPool,
    started: Cell<Instant>,
    gpu: Gpu,
}

impl Timer {
    /// A timer for one command buffer at a time.
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let info =
            vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
        // SAFETY: the pool is destroyed on drop.
        let pool = unsafe { gpu.device.create_query_pool(&info, None)? };
        Ok(Self { pool, started: Cell::new(Instant::now()), gpu: gpu.clone() })
    }

    /// Starts the clock when all earlier commands are done.
    pub fn start(&self, cmd: vk::CommandBuffer) {
        self.started.set(Instant::now());
        if self.gpu.limits.has_timestamps() {
            // SAFETY: the pool is alive until the submission is done, here and in `stamp`.
            unsafe { self.gpu.device.cmd_reset_query_pool(cmd, self.pool, 0, 2) };
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
        // SAFETY: as in `start`.
        unsafe { self.gpu.device.cmd_write_timestamp2(cmd, stage, self.pool, query) };
    }

    /// Milliseconds between start and stop, to be asked for as soon as the commands are done.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn milliseconds(&self) -> Result<f64> {
        if !self.gpu.limits.has_timestamps() {
            return Ok(self.started.get().elapsed().as_secs_f64() * 1e3);
        }
        let mut stamps = [0u64; 2];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: both queries were written by a submission that is done.
        unsafe { self.gpu.device.get_query_pool_results(self.pool, 0, &mut stamps, flags)? };
        // Some queues count in fewer than 64 bits, and start again from 0.
        let limits = &self.gpu.limits;
        let ticks = stamps[1].wrapping_sub(stamps[0]) & u64::MAX >> (64 - limits.timestamp_bits);
        Ok(ticks as f64 * f64::from(limits.core.timestamp_period) * 1e-6)
    }
}

impl Drop for Timer {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe { self.gpu.device.destroy_query_pool(self.pool, None) };
    }
}
