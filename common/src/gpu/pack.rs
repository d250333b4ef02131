//! Many arrays in one buffer: a buffer for each would cost time and memory, and a device has room for some
//! thousands of allocations only.

use std::marker::PhantomData;

use anyhow::{Result, ensure};
use ash::vk;
use bytemuck::Pod;

use super::{ADDRESS_ALIGNMENT, Buffer, Gpu};

/// A buffer that arrays of `T` are put into one after the other, each at a multiple of [`ADDRESS_ALIGNMENT`].
pub struct Pack<T> {
    buffer: Buffer,
    staging: Buffer,
    /// Bytes that wait in the staging buffer.
    staged: usize,
    /// Bytes that are on the device.
    copied: u64,
    arrays: PhantomData<fn() -> T>,
}

impl<T: Pod> Pack<T> {
    /// Room for arrays of so many elements each, with a device address.
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(
        gpu: &Gpu,
        name: &str,
        lengths: impl Iterator<Item = usize>,
        usage: vk::BufferUsageFlags,
    ) -> Result<Self> {
        let size = lengths.map(room::<T>).sum::<usize>() as u64;
        let usage = usage
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | vk::BufferUsageFlags::TRANSFER_DST;
        Ok(Self {
            buffer: Buffer::new(gpu, name, size, usage)?,
            staging: Buffer::staging(gpu, size)?,
            staged: 0,
            copied: 0,
            arrays: PhantomData,
        })
    }

    /// Puts an array behind those before; its address.
    ///
    /// # Errors
    /// If the copy fails, or there is no room for it.
    pub fn push(&mut self, array: &[T]) -> Result<vk::DeviceAddress> {
        let offset = self.copied + self.staged as u64;
        let room = room::<T>(array.len());
        ensure!(offset + room as u64 <= self.buffer.size, "no room for {room} bytes at {offset}");
        let bytes: &[u8] = bytemuck::cast_slice(array);
        self.stage(bytes)?;
        self.stage(&[0; ADDRESS_ALIGNMENT as usize][..room - bytes.len()])?;
        Ok(self.buffer.address + offset)
    }

    /// The buffer with all that was put into it.
    ///
    /// # Errors
    /// If the copy fails.
    pub fn finish(mut self) -> Result<Buffer> {
        self.copy()?;
        Ok(self.buffer)
    }

    fn stage(&mut self, mut bytes: &[u8]) -> Result<()> {
        while !bytes.is_empty() {
            let free = &mut self.staging.mapped_bytes()[self.staged..];
            let (now, later) = bytes.split_at(bytes.len().min(free.len()));
            free[..now.len()].copy_from_slice(now);
            self.staged += now.len();
            bytes = later;
            if self.staged as u64 == self.staging.size {
                self.copy()?;
            }
        }
        Ok(())
    }

    fn copy(&mut self) -> Result<()> {
        if self.staged > 0 {
            self.buffer.copy_from(&self.staging, self.staged as u64, self.copied)?;
            self.copied += self.staged as u64;
            self.staged = 0;
        }
        Ok(())
    }
}

/// Bytes that an array of `T` takes. An empty one takes some too: an address behind the buffer's last byte
/// would be none of the buffer's.
fn room<T>(length: usize) -> usize {
    (length * size_of::<T>()).max(1).next_multiple_of(ADDRESS_ALIGNMENT as usize)
}
