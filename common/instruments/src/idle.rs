//! Devices that execute nothing, as Mesa's stand-ins for cards do: all their results are zeros.

use anyhow::{Result, ensure};
use ash::vk::{self, BufferUsageFlags as Usage};
use common::gpu::{Buffer, Gpu, barrier};

/// Bytes to fill. A driver may fill a few without the device's processors, and so even for a stand-in.
const BYTES: u64 = 1 << 16;
/// The word to fill them with.
const WORD: u32 = 0x5eed_ed11;

/// Fails if the device executes nothing, with the reason why that matters here.
///
/// # Errors
/// If it does not even fill a buffer, or the device fails.
pub fn refuse(gpu: &Gpu, why: &str) -> Result<()> {
    let usage = Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let buffer = Buffer::new(gpu, "to be filled", BYTES, usage)?;
    gpu.submit(|cmd| {
        // SAFETY: cmd is being recorded on this device, and the buffer outlives the submission, which is waited for.
        unsafe { gpu.device.cmd_fill_buffer(cmd, buffer.handle, 0, vk::WHOLE_SIZE, WORD) };
        barrier::fill_to_trace(gpu, cmd);
        Ok(())
    })?;
    let is_filled = buffer.read::<u32>()?.last() == Some(&WORD);
    ensure!(is_filled, "{} executes nothing, like every stand-in for a card: {why}", gpu.name);
    Ok(())
}
