//! Opacity micromaps supported by the device: acceleration structures of states, referenced by bottom levels.

use anyhow::{Context, Result, ensure};
use ash::vk;

use super::build::scratch_buffer;
use super::place::OFFSET_ALIGNMENT;
use crate::gpu::accel::micromap_extension::{
    self, CreateAccelerationStructure2, CreateInfo2, INPUT_ALIGNMENT, MicromapData,
    MicromapTriangle, MicromapUsage, TrianglesMicromap,
};
use crate::gpu::{Buffer, Gpu, barrier};

/// An opacity micromap of `VK_KHR_opacity_micromap`: a `VkAccelerationStructureKHR`, freed on drop. It must
/// outlive each bottom level built with it.
pub struct OpacityMicromap {
    /// The Vulkan handle.
    pub handle: vk::AccelerationStructureKHR,
    /// Its size in bytes.
    pub size: u64,
    _buffer: Buffer,
    gpu: Gpu,
}

impl OpacityMicromap {
    /// The finest level the device supports with four states per part; `None` if it does not support micromaps.
    pub fn finest(gpu: &Gpu) -> Option<u32> {
        let is_known = gpu.features.micromap.micromap == vk::TRUE;
        is_known.then_some(gpu.limits.micromap.max_opacity4_state_subdivision_level)
    }

    /// Builds it from triangles of one level. Their states, two bits each and at least a byte per triangle, are
    /// stored one triangle after the other.
    ///
    /// # Errors
    /// If the device does not support micromaps, this level or so many triangles; if memory is short.
    pub fn new(gpu: &Gpu, name: &str, states: &[u8], level: u32) -> Result<Self> {
        let finest = Self::finest(gpu).context("micromaps were not asked for, or are not there")?;
        ensure!(level <= finest, "'{name}' has level {level}, and {} takes {finest}", gpu.name);
        let bytes = (1usize << (2 * level)).div_ceil(4);
        let count = states.len() / bytes;
        let most = gpu.limits.micromap.max_micromap_triangles;
        ensure!(
            count as u64 <= most,
            "'{name}' has {count} triangles, and {} takes {most}",
            gpu.name
        );
        let triangle = |i: usize| MicromapTriangle {
            data_offset: (i * bytes) as u32,
            subdivision_level: level as u16,
            format: micromap_extension::FORMAT_4_STATE,
        };
        let triangles: Vec<_> = (0..count).map(triangle).collect();
        // ANCHOR: input
        // Only the build reads them; they are freed at the end of this function.
        let (_states, data) = input(gpu, states)?;
        let (_triangles, triangle_array) = input(gpu, bytemuck::cast_slice(&triangles))?;
        let format = micromap_extension::FORMAT_4_STATE.into();
        let usage = MicromapUsage { count: count as u32, subdivision_level: level, format };
        let input = MicromapData {
            usage_counts_count: 1,
            p_usage_counts: &raw const usage,
            data,
            triangle_array,
            ..MicromapData::default()
        };
        // ANCHOR_END: input
        Self::build(gpu, name, &input).with_context(|| format!("cannot build '{name}'"))
    }

    fn build(gpu: &Gpu, name: &str, input: &MicromapData) -> Result<Self> {
        let geometry = vk::AccelerationStructureGeometryKHR {
            p_next: std::ptr::from_ref(input).cast(),
            geometry_type: micromap_extension::GEOMETRY_TYPE,
            ..Default::default()
        };
        let info = vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(micromap_extension::TYPE)
            .flags(vk::BuildAccelerationStructureFlagsKHR::PREFER_FAST_TRACE)
            .geometries(std::slice::from_ref(&geometry));
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        let calls = gpu.acceleration_structure.fp();
        let on_device = vk::AccelerationStructureBuildTypeKHR::DEVICE;
        // SAFETY: info and everything it points to are alive; a micromap has no primitives to count, so there is
        // no list.
        unsafe {
            (calls.get_acceleration_structure_build_sizes_khr)(
                gpu.device.handle(),
                on_device,
                &raw const info,
                std::ptr::null(),
                &raw mut sizes,
            );
        }
        let micromap = Self::create(gpu, name, sizes.acceleration_structure_size)?;
        let scratch = scratch_buffer(gpu, sizes.build_scratch_size)?;
        let info = info
            .dst_acceleration_structure(micromap.handle)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: scratch.address });
        gpu.submit(|cmd| {
            // Nor does it have ranges.
            let ranges = [std::ptr::null()];
            // SAFETY: every address in info belongs to a buffer that outlives the submission.
            unsafe {
                let build = calls.cmd_build_acceleration_structures_khr;
                build(cmd, 1, &raw const info, ranges.as_ptr());
            }
            barrier::between_builds(gpu, cmd);
            Ok(())
        })?;
        Ok(micromap)
    }

    /// A micromap at an address, not built yet: the older call does not accept micromaps.
    fn create(gpu: &Gpu, name: &str, size: u64) -> Result<Self> {
        let function = c"vkCreateAccelerationStructure2KHR";
        let (instance, device) = (&gpu.vulkan.instance, gpu.device.handle());
        // SAFETY: the device belongs to the instance, and the name ends in a zero byte.
        let found = unsafe { instance.get_device_proc_addr(device, function.as_ptr()) };
        let found = found.context("no vkCreateAccelerationStructure2KHR")?;
        // SAFETY: it is the function of that name.
        let create: CreateAccelerationStructure2 = unsafe { std::mem::transmute(found) };
        let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let (_buffer, address) = aligned(gpu, name, size, OFFSET_ALIGNMENT, usage)?;
        let info =
            CreateInfo2 { address, size, ty: micromap_extension::TYPE, ..CreateInfo2::default() };
        let mut handle = vk::AccelerationStructureKHR::null();
        // SAFETY: the buffer has room there and lives as long as the structure.
        unsafe { create(device, &raw const info, std::ptr::null(), &raw mut handle) }.result()?;
        gpu.name_object(handle, name);
        gpu.count(|statistics| statistics.acceleration_structure_bytes += size);
        Ok(Self { handle, size, _buffer, gpu: gpu.clone() })
    }

    /// For [`BuildOptions::micromap`](super::BuildOptions::micromap): primitive `i` of the bottom level uses the
    /// triangle whose 32-bit number is element `i` of an array at that address.
    pub fn by_indices(&self, index_buffer: vk::DeviceAddress) -> TrianglesMicromap {
        TrianglesMicromap { index_buffer, micromap: self.handle, ..TrianglesMicromap::default() }
    }
}

impl Drop for OpacityMicromap {
    fn drop(&mut self) {
        let extension = &self.gpu.acceleration_structure;
        // SAFETY: submissions are waited for, so no trace or build uses it any more.
        unsafe { extension.destroy_acceleration_structure(self.handle, None) };
        self.gpu.count(|statistics| statistics.acceleration_structure_bytes -= self.size);
    }
}

/// A buffer with the input of a micromap build, and its address.
fn input(gpu: &Gpu, bytes: &[u8]) -> Result<(Buffer, vk::DeviceAddress)> {
    let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
        | vk::BufferUsageFlags::TRANSFER_DST;
    let size = bytes.len() as u64;
    let (buffer, address) = aligned(gpu, "micromap input", size, INPUT_ALIGNMENT, usage)?;
    buffer.write(address - buffer.address, bytes)?;
    Ok((buffer, address))
}

/// A buffer, and an address in it that is a multiple of `alignment` and is followed by `size` bytes.
fn aligned(
    gpu: &Gpu,
    name: &str,
    size: u64,
    alignment: u64,
    usage: vk::BufferUsageFlags,
) -> Result<(Buffer, vk::DeviceAddress)> {
    let buffer = Buffer::new(gpu, name, size + alignment, usage)?;
    let address = buffer.address.next_multiple_of(alignment);
    Ok((buffer, address))
}
