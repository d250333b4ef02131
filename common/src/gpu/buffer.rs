//! A buffer and its memory: uploaded once, addressed from shaders, read back for tests.

use std::ffi::c_void;
use std::ptr::NonNull;

use anyhow::{Context, Result, ensure};
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::{Gpu, barrier};

/// What `vkCmdUpdateBuffer` takes at most, in bytes.
const MOST_UPDATED: usize = 65_536;

/// How many bytes a staging buffer has at most: what is larger goes in parts, and memory does not hold it twice.
const MOST_STAGED: u64 = 32 << 20;

/// What the address of every addressed buffer is a multiple of: what shaders may promise of the addresses
/// that they read through (GLSL's `buffer_reference_align` is 16 unless it says otherwise), and what builds
/// ask of their input, 16 for instances and 8 for boxes.
pub const ADDRESS_ALIGNMENT: u64 = 16;

/// A `VkBuffer` bound to memory of its own, freed on drop.
pub struct Buffer {
    /// The Vulkan handle.
    pub handle: vk::Buffer,
    /// Its size in bytes.
    pub size: u64,
    /// Its device address; 0 unless made with `SHADER_DEVICE_ADDRESS`.
    pub address: vk::DeviceAddress,
    allocation: Option<Allocation>,
    gpu: Gpu,
}

impl Buffer {
    /// An uninitialised buffer of at least one byte in device memory.
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(gpu: &Gpu, name: &str, size: u64, usage: vk::BufferUsageFlags) -> Result<Self> {
        Self::in_memory(gpu, name, size, usage, MemoryLocation::GpuOnly, 1)
    }

    /// As [`Buffer::new`], its address a multiple of `alignment` bytes (a power of two).
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn aligned(
        gpu: &Gpu,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        alignment: u64,
    ) -> Result<Self> {
        Self::in_memory(gpu, name, size, usage, MemoryLocation::GpuOnly, alignment)
    }

    /// A buffer in device memory that holds `data`.
    ///
    /// # Errors
    /// As [`Buffer::new`], or if the copy fails.
    pub fn with_data<T: Pod>(
        gpu: &Gpu,
        name: &str,
        data: &[T],
        usage: vk::BufferUsageFlags,
    ) -> Result<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let buffer =
            Self::new(gpu, name, bytes.len() as u64, usage | vk::BufferUsageFlags::TRANSFER_DST)?;
        buffer.write(0, data)?;
        Ok(buffer)
    }

    /// A buffer that the host has mapped, to write into (`CpuToGpu`) or read from (`GpuToCpu`).
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn mapped(
        gpu: &Gpu,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self> {
        Self::in_memory(gpu, name, size, usage, location, 1)
    }

    fn in_memory(
        gpu: &Gpu,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
        alignment: u64,
    ) -> Result<Self> {
        // Vulkan has no empty buffers; an empty mesh or table still wants an address.
        let size = size.max(1);
        let most = gpu.limits.max_buffer_size;
        ensure!(
            size <= most,
            "the buffer '{name}' takes {size} bytes, and {} has room for {most} in one",
            gpu.name
        );
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the device is alive; the buffer is destroyed on every path below.
        let handle = unsafe { gpu.device.create_buffer(&info, None) }
            .with_context(|| format!("cannot make the buffer '{name}' of {size} bytes"))?;
        let mut buffer = Self { handle, size, address: 0, allocation: None, gpu: gpu.clone() };
        // SAFETY: as above.
        let mut requirements = unsafe { gpu.device.get_buffer_memory_requirements(handle) };
        let addressed = usage.contains(vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS);
        let alignment = alignment.max(if addressed { ADDRESS_ALIGNMENT } else { 1 });
        requirements.alignment = requirements.alignment.max(alignment);
        let allocation = gpu
            .allocator
            .lock()
            .map_err(|_| anyhow::anyhow!("an allocating thread panicked"))?
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear: true,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .with_context(|| format!("no memory for the buffer '{name}' of {size} bytes"))?;
        // SAFETY: the memory is bound below and freed after the buffer.
        let (memory, offset) = unsafe { (allocation.memory(), allocation.offset()) };
        // Where the host has no room to map it, some drivers hand out `MAP_FAILED`, which is -1.
        let start = |at: NonNull<c_void>| at.addr().get().wrapping_sub(offset as usize);
        let unmapped = allocation.mapped_ptr().is_some_and(|at| start(at) == usize::MAX);
        buffer.allocation = Some(allocation);
        ensure!(!unmapped, "no address space for the buffer '{name}' of {size} bytes");
        // SAFETY: the allocation was made for this buffer's requirements and is freed after it.
        unsafe { gpu.device.bind_buffer_memory(handle, memory, offset) }
            .with_context(|| format!("no memory for the buffer '{name}' of {size} bytes"))?;
        if addressed {
            let info = vk::BufferDeviceAddressInfo::default().buffer(handle);
            // SAFETY: the buffer is bound and was made for addressing.
            buffer.address = unsafe { gpu.device.get_buffer_device_address(&info) };
            // The offset in memory is aligned; that the memory's own address is, no rule promises.
            ensure!(
                buffer.address.is_multiple_of(alignment),
                "the buffer '{name}' lies at {:#x}, which is no multiple of {alignment}",
                buffer.address
            );
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
        if bytes.is_empty() {
            return Ok(());
        }
        ensure!(
            offset + bytes.len() as u64 <= self.size,
            "{} bytes at {offset} do not fit a buffer of {} bytes",
            bytes.len(),
            self.size
        );
        let mut staging = Self::staging(&self.gpu, bytes.len() as u64)?;
        let mut at = offset;
        for part in bytes.chunks(MOST_STAGED as usize) {
            staging.mapped_bytes()[..part.len()].copy_from_slice(part);
            self.copy_from(&staging, part.len() as u64, at)?;
            at += part.len() as u64;
        }
        Ok(())
    }

    /// A mapped buffer for [`Buffer::copy_from`]: as large as what is to be copied, but no larger than a few
    /// copies one after the other need.
    pub(super) fn staging(gpu: &Gpu, size: u64) -> Result<Self> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        Self::mapped(gpu, "staging", size.min(MOST_STAGED), usage, MemoryLocation::CpuToGpu)
    }

    /// Copies the first bytes of `staging` to the buffer, `offset` bytes from its start, and waits for it.
    pub(super) fn copy_from(&self, staging: &Self, size: u64, offset: u64) -> Result<()> {
        self.gpu.submit(|cmd| {
            let region = vk::BufferCopy::default().dst_offset(offset).size(size);
            // SAFETY: both buffers outlive the submission, which is waited for.
            unsafe {
                self.gpu.device.cmd_copy_buffer(cmd, staging.handle, self.handle, &[region]);
            }
            barrier::after_upload(&self.gpu, cmd);
            Ok(())
        })
    }

    /// Records that the buffer begins with `data` for the traces and builds that follow in `cmd`; the host does
    /// not wait.
    ///
    /// For what changes from frame to frame and is small, as the commands hold a copy of it: a multiple of
    /// 4 bytes, into a buffer made with `TRANSFER_DST`.
    ///
    /// # Errors
    /// If the data is none of that, or does not fit.
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

    /// Records that all of it is 0 for the traces that follow in `cmd`; made with `TRANSFER_DST`.
    pub fn clear(&self, cmd: vk::CommandBuffer) {
        barrier::trace_to_fill(&self.gpu, cmd);
        // SAFETY: cmd is being recorded on this device, and the buffer outlives the submission.
        unsafe { self.gpu.device.cmd_fill_buffer(cmd, self.handle, 0, vk::WHOLE_SIZE, 0) };
        barrier::fill_to_trace(&self.gpu, cmd);
    }

    /// The content as a vector of `T`, copied back through a mapped buffer.
    ///
    /// The buffer must have been made with `TRANSFER_SRC`; bytes beyond a whole `T` are left out.
    ///
    /// # Errors
    /// If the copy fails.
    pub fn read<T: Pod>(&self) -> Result<Vec<T>> {
        let mut staging = Self::mapped(
            &self.gpu,
            "readback",
            self.size,
            vk::BufferUsageFlags::TRANSFER_DST,
            MemoryLocation::GpuToCpu,
        )?;
        self.gpu.submit(|cmd| {
            let region = vk::BufferCopy::default().size(self.size);
            barrier::before_readback(&self.gpu, cmd);
            // SAFETY: both buffers outlive the submission, which is waited for.
            unsafe {
                self.gpu.device.cmd_copy_buffer(cmd, self.handle, staging.handle, &[region]);
            }
            barrier::after_readback(&self.gpu, cmd);
            Ok(())
        })?;
        let whole = self.size as usize / size_of::<T>() * size_of::<T>();
        Ok(bytemuck::pod_collect_to_vec(&staging.mapped_bytes()[..whole]))
    }

    /// The mapped bytes of a buffer made with [`Buffer::mapped`].
    ///
    /// # Panics
    /// If the buffer lives in device memory only.
    pub fn mapped_bytes(&mut self) -> &mut [u8] {
        let allocation = self.allocation.as_mut().expect("a live buffer has its memory");
        let bytes = allocation.mapped_slice_mut().expect("the buffer was made with Buffer::mapped");
        &mut bytes[..self.size as usize]
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for, so the device no longer uses the buffer.
        unsafe { self.gpu.device.destroy_buffer(self.handle, None) };
        if let (Some(allocation), Ok(mut allocator)) =
            (self.allocation.take(), self.gpu.allocator.lock())
        {
            // Freeing fails only for memory of another allocator.
            let _ = allocator.free(allocation);
        }
    }
}
