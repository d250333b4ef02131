//! A buffer and its memory: uploaded once, addressed from shaders, read back for tests.

use std::ffi::c_void;
use std::ptr::NonNull;

use anyhow::{Context, Result, ensure};
use ash::vk::{self, BufferUsageFlags as Usage};
use bytemuck::Pod;
use gpu_allocator::MemoryLocation;

use crate::gpu::memory::Memory;
use crate::gpu::memory::arrays::Array;
use crate::gpu::memory::staging::{Staging, read_back};
use crate::gpu::{Gpu, barrier};

/// The limit of `vkCmdUpdateBuffer`, in bytes.
const MOST_UPDATED: usize = 65_536;

/// The guaranteed alignment of a buffer's address on any device: shaders may promise it for the addresses they
/// read through (GLSL's `buffer_reference_align` is 16 by default), and it suffices for the input of builds, 16
/// for instances and 8 for boxes.
pub const ADDRESS_ALIGNMENT: u64 = 16;

/// A `VkBuffer` bound to memory of its own, freed on drop.
pub struct Buffer {
    /// The Vulkan handle.
    pub handle: vk::Buffer,
    /// Its size in bytes.
    pub size: u64,
    /// Its device address; 0 unless made with `SHADER_DEVICE_ADDRESS`.
    pub address: vk::DeviceAddress,
    memory: Option<Memory>,
    gpu: Gpu,
}

impl Buffer {
    /// The usage of buffers that shaders read or write by address.
    pub const ADDRESSED: Usage =
        Usage::from_raw(Usage::SHADER_DEVICE_ADDRESS.as_raw() | Usage::STORAGE_BUFFER.as_raw());

    /// An uninitialised buffer of at least one byte in device memory. Its address, if it has one, is aligned for
    /// any use: [`Limits::address_alignment`](crate::gpu::Limits::address_alignment).
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(gpu: &Gpu, name: &str, size: u64, usage: Usage) -> Result<Self> {
        Self::make(gpu, name, size, usage, MemoryLocation::GpuOnly)
    }

    /// A buffer in device memory that holds `data`.
    ///
    /// # Errors
    /// As [`Buffer::new`], or if the copy fails.
    pub fn with_data<T: Pod>(gpu: &Gpu, name: &str, data: &[T], usage: Usage) -> Result<Self> {
        Ok(Self::with_arrays(gpu, name, [data], usage)?.0)
    }

    /// A buffer in device memory that contains arrays one after the other, and the address of each, a multiple of
    /// [`ADDRESS_ALIGNMENT`].
    ///
    /// A buffer for each would cost time and memory, and a device allows only some thousands of allocations.
    ///
    /// # Errors
    /// As [`Buffer::with_data`].
    pub fn with_arrays<T: Pod, A: AsRef<[T]>>(
        gpu: &Gpu,
        name: &str,
        arrays: impl IntoIterator<Item = A>,
        usage: Usage,
    ) -> Result<(Self, Vec<vk::DeviceAddress>)> {
        let arrays: Vec<A> = arrays.into_iter().collect();
        // An empty array gets one byte: an address after the buffer's last byte would not be inside the buffer.
        let sizes = arrays.iter().map(|array| size_of_val(array.as_ref()).max(1) as u64);
        let (offsets, size) = offsets(sizes, ADDRESS_ALIGNMENT);
        let buffer = Self::new(gpu, name, size, usage | Usage::TRANSFER_DST)?;
        let mut staging = Staging::new(gpu, size as usize)?;
        for (array, &offset) in arrays.iter().zip(&offsets) {
            staging.fill_buffer(&buffer, offset, bytemuck::cast_slice(array.as_ref()))?;
        }
        staging.submit()?;
        let addresses: Vec<_> = offsets.iter().map(|offset| buffer.address + offset).collect();
        // Each array is known by its own length, so that no build reads into the next one.
        if buffer.address != 0 {
            let lengths = arrays.iter().map(|array| size_of_val(array.as_ref()) as u64);
            for ((&address, offset), bytes) in addresses.iter().zip(offsets).zip(lengths) {
                let name = name.to_owned();
                let array = Array { name, buffer: buffer.handle, offset, bytes };
                gpu.arrays().add(address, array);
            }
        }
        Ok((buffer, addresses))
    }

    /// A mapped buffer, to copy from (`CpuToGpu`) or to (`GpuToCpu`).
    pub(in crate::gpu) fn mapped(
        gpu: &Gpu,
        name: &str,
        size: u64,
        at: MemoryLocation,
    ) -> Result<Self> {
        Self::make(gpu, name, size, Usage::TRANSFER_SRC | Usage::TRANSFER_DST, at)
    }

    fn make(gpu: &Gpu, name: &str, size: u64, usage: Usage, at: MemoryLocation) -> Result<Self> {
        // Vulkan has no empty buffers, but an empty mesh or table still needs an address.
        let size = size.max(1);
        let most = gpu.limits.max_buffer_size();
        ensure!(
            size <= most,
            "the buffer '{name}' takes {size} bytes, and {} has room for {most} in one",
            gpu.name
        );
        let addressed = usage.contains(Usage::SHADER_DEVICE_ADDRESS);
        // Under validation, the inputs of builds are read back and checked.
        let is_read = addressed && gpu.is_validated();
        let usage = if is_read { usage | Usage::TRANSFER_SRC } else { usage };
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the device is alive; the buffer is destroyed on every path below.
        let handle = unsafe { gpu.device.create_buffer(&info, None) }
            .with_context(|| format!("cannot make the buffer '{name}' of {size} bytes"))?;
        let mut buffer = Self { handle, size, address: 0, memory: None, gpu: gpu.clone() };
        // SAFETY: as above.
        let mut requirements = unsafe { gpu.device.get_buffer_memory_requirements(handle) };
        let alignment = if addressed { gpu.limits.address_alignment() } else { 1 };
        requirements.alignment = requirements.alignment.max(alignment);
        let no_memory = || format!("no memory for the buffer '{name}' of {size} bytes");
        let memory = Memory::new(gpu, name, requirements, at, true).with_context(no_memory)?;
        let allocation = &buffer.memory.insert(memory).allocation;
        let offset = allocation.offset();
        // If the host cannot map the memory, some drivers return `MAP_FAILED`, which is -1.
        let start = |first: NonNull<c_void>| first.addr().get().wrapping_sub(offset as usize);
        let unmapped = allocation.mapped_ptr().is_some_and(|first| start(first) == usize::MAX);
        ensure!(!unmapped, "no address space for the buffer '{name}' of {size} bytes");
        // SAFETY: the allocation was made for this buffer's requirements and is freed after it.
        unsafe { gpu.device.bind_buffer_memory(handle, allocation.memory(), offset) }
            .with_context(no_memory)?;
        if addressed {
            let info = vk::BufferDeviceAddressInfo::default().buffer(handle);
            // SAFETY: the buffer is bound and was made for addressing.
            buffer.address = unsafe { gpu.device.get_buffer_device_address(&info) };
            // The offset in memory is aligned, but no rule guarantees that for the memory's own address.
            ensure!(
                buffer.address.is_multiple_of(alignment),
                "the buffer '{name}' lies at {:#x}, which is no multiple of {alignment}",
                buffer.address
            );
            let array = Array { name: name.to_owned(), buffer: handle, offset: 0, bytes: size };
            gpu.arrays().add(buffer.address, array);
        }
        gpu.name_object(handle, name);
        Ok(buffer)
    }

    /// Copies `data` to the buffer, `offset` bytes from its start, and waits for it.
    ///
    /// # Errors
    /// If the data does not fit, or the copy fails.
    pub fn write<T: Pod>(&self, offset: u64, data: &[T]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        ensure!(
            offset + bytes.len() as u64 <= self.size,
            "{} bytes at {offset} do not fit a buffer of {} bytes",
            bytes.len(),
            self.size
        );
        let mut staging = Staging::new(&self.gpu, bytes.len())?;
        staging.fill_buffer(self, offset, bytes)?;
        staging.submit()
    }

    /// Records that the buffer begins with `data` for the traces and builds that follow in `cmd`; does not wait.
    ///
    /// For small data that changes from frame to frame, because the commands hold a copy of it: a multiple of 4
    /// bytes, into a buffer with `TRANSFER_DST`.
    ///
    /// # Errors
    /// If the data does not meet these conditions, or does not fit.
    pub fn update<T: Pod>(&self, cmd: vk::CommandBuffer, data: &[T]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let size = bytes.len() as u64;
        ensure!(
            size <= self.size && size.is_multiple_of(4),
            "{size} bytes cannot be recorded for a buffer of {} bytes",
            self.size
        );
        barrier::reads_to_update(&self.gpu, cmd);
        for (number, part) in bytes.chunks(MOST_UPDATED).enumerate() {
            let offset = (number * MOST_UPDATED) as u64;
            // SAFETY: cmd is being recorded on this device; the bytes are copied into it here.
            unsafe { self.gpu.device.cmd_update_buffer(cmd, self.handle, offset, part) };
        }
        barrier::update_to_reads(&self.gpu, cmd);
        Ok(())
    }

    /// Records that the whole buffer is 0 for the traces that follow in `cmd`; needs `TRANSFER_DST`.
    pub fn clear(&self, cmd: vk::CommandBuffer) {
        barrier::trace_to_fill(&self.gpu, cmd);
        // SAFETY: cmd is being recorded on this device, and the buffer outlives the submission.
        unsafe { self.gpu.device.cmd_fill_buffer(cmd, self.handle, 0, vk::WHOLE_SIZE, 0) };
        barrier::fill_to_trace(&self.gpu, cmd);
    }

    /// The contents as a vector of `T`, copied back through a mapped buffer.
    ///
    /// The buffer must have `TRANSFER_SRC`; bytes beyond a whole `T` are left out.
    ///
    /// # Errors
    /// If the copy fails.
    pub fn read<T: Pod>(&self) -> Result<Vec<T>> {
        let mut copy = read_back(&self.gpu, "readback", self.size, |cmd, to| {
            let region = vk::BufferCopy::default().size(self.size);
            barrier::before_readback(&self.gpu, cmd);
            // SAFETY: both buffers outlive the submission, which is waited for.
            unsafe { self.gpu.device.cmd_copy_buffer(cmd, self.handle, to, &[region]) };
        })?;
        let whole = self.size as usize / size_of::<T>() * size_of::<T>();
        Ok(bytemuck::pod_collect_to_vec(&copy.mapped_bytes()[..whole]))
    }

    /// The bytes of a mapped buffer.
    ///
    /// # Panics
    /// If the buffer is in device memory only.
    pub(in crate::gpu) fn mapped_bytes(&mut self) -> &mut [u8] {
        let memory = self.memory.as_mut().expect("a live buffer has its memory");
        let bytes = memory.allocation.mapped_slice_mut().expect("the buffer was made mapped");
        &mut bytes[..self.size as usize]
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        if self.address != 0 {
            self.gpu.arrays().forget(self.address, self.size);
        }
        // SAFETY: submissions are waited for, so the device no longer uses the buffer.
        unsafe { self.gpu.device.destroy_buffer(self.handle, None) };
    }
}

/// Offsets of consecutive parts of these sizes, each at a multiple of `alignment`, and the total size.
pub(in crate::gpu) fn offsets(sizes: impl Iterator<Item = u64>, alignment: u64) -> (Vec<u64>, u64) {
    let mut end = 0u64;
    let offsets = sizes.map(|size| {
        let offset = end.next_multiple_of(alignment);
        end = offset + size;
        offset
    });
    (offsets.collect(), end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_begins_where_it_may_and_ends_before_the_next() {
        assert_eq!(offsets([1, 256, 300, 7].into_iter(), 256), (vec![0, 256, 512, 1024], 1031));
    }
}
