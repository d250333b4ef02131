//! Submission: records commands, submits them and waits for them.

use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result};
use ash::prelude::VkResult;
use ash::vk;

use super::Gpu;
use crate::output;

/// Time limit for one submission: far longer than systems let a device work without responding, and than a
/// software driver needs to build the largest model.
const PATIENCE: Duration = Duration::from_secs(600);

/// Number of retries of a wait that failed for lack of host memory, and the pause between them.
const TRIES: u32 = 50;
const PAUSE: Duration = Duration::from_millis(20);

/// Number of submissions that the devices of this process have not finished.
static AT_WORK: AtomicU32 = AtomicU32::new(0);

/// True if a device of this process is at work: a crash is then most likely a shader's.
pub fn is_at_work() -> bool {
    AT_WORK.load(Ordering::Relaxed) > 0
}

impl Gpu {
    /// Records commands with `record`, submits them, and waits for their completion.
    ///
    /// # Errors
    /// If recording or the device fails.
    pub fn submit<R>(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<R>) -> Result<R> {
        self.submit_with(vk::SubmitInfo2::default(), record)
    }

    /// As [`Gpu::submit`], but waits for the semaphore `before` and signals `after` at its end.
    ///
    /// # Errors
    /// As [`Gpu::submit`].
    pub fn submit_between<R>(
        &self,
        before: vk::Semaphore,
        after: vk::Semaphore,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R>,
    ) -> Result<R> {
        let [before, after] = [before, after].map(|semaphore| {
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            [vk::SemaphoreSubmitInfo::default().semaphore(semaphore).stage_mask(stage)]
        });
        let submit = vk::SubmitInfo2::default();
        let submit = submit.wait_semaphore_infos(&before).signal_semaphore_infos(&after);
        self.submit_with(submit, record)
    }

    fn submit_with<R>(
        &self,
        submit: vk::SubmitInfo2,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R>,
    ) -> Result<R> {
        let pool = self.command_pool;
        let info =
            vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        // SAFETY: the pool is ours, and every handle below is alive until the wait has ended.
        unsafe {
            let cmd = self.device.allocate_command_buffers(&info)?[0];
            let begin = vk::CommandBufferBeginInfo::default()
                .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            self.device.begin_command_buffer(cmd, &begin)?;
            let done = record(cmd).and_then(|result| {
                self.device.end_command_buffer(cmd)?;
                let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(cmd)];
                self.run(submit.command_buffer_infos(&buffers))?;
                Ok(result)
            });
            self.device.free_command_buffers(pool, &[cmd]);
            done
        }
    }

    fn run(&self, submit: vk::SubmitInfo2) -> Result<()> {
        // SAFETY: the commands are recorded; the fence is destroyed after the wait.
        unsafe {
            let fence = self.device.create_fence(&vk::FenceCreateInfo::default(), None)?;
            AT_WORK.fetch_add(1, Ordering::Relaxed);
            let submitted = self.device.queue_submit2(self.queue, &[submit], fence);
            let wait = || self.device.wait_for_fences(&[fence], true, PATIENCE.as_nanos() as u64);
            let done = submitted.and_then(|()| self.insist(wait));
            AT_WORK.fetch_sub(1, Ordering::Relaxed);
            self.device.destroy_fence(fence, None);
            done.context("the device failed while it worked")
        }
    }

    /// Waits until the queue is idle, or the device is lost.
    ///
    /// # Errors
    /// If the device is lost.
    pub(super) fn wait_for_queue(&self) -> VkResult<()> {
        // SAFETY: the queue is used by one thread at a time.
        self.insist(|| unsafe { self.device.queue_wait_idle(self.queue) })
    }

    /// Waits until the device has finished or is lost, which also ends its work; retries if need be.
    ///
    /// The caller may then free the resources the device used. So this never returns while the device may be
    /// working: a wait that keeps failing, or never ends, ends the process.
    fn insist(&self, wait: impl Fn() -> VkResult<()>) -> VkResult<()> {
        let mut last = vk::Result::TIMEOUT;
        for _ in 0..TRIES {
            match wait() {
                Ok(()) => return Ok(()),
                Err(vk::Result::ERROR_DEVICE_LOST) => return Err(vk::Result::ERROR_DEVICE_LOST),
                Err(vk::Result::TIMEOUT) => break,
                Err(error) => last = error,
            }
            thread::sleep(PAUSE);
        }
        let why = match last {
            vk::Result::TIMEOUT => format!("has not answered for {} s", PATIENCE.as_secs()),
            error => format!("cannot be waited for: {error}"),
        };
        output::complain(&format!("error: {} {why}", self.name));
        std::process::exit(1)
    }
}
