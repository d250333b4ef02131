//! Commands that read and write buffers and acceleration structures, as tracked by [`order`].

use std::collections::BTreeSet;
use std::ffi::c_void;
use std::sync::{Mutex, MutexGuard, PoisonError};

use ash::vk::PipelineStageFlags2 as Stage;
use ash::vk::{self, AccessFlags2 as Access, BufferUsageFlags as Usage, Handle};
use layer::below;

use crate::faults;
use crate::order::{self, Kind, Use};

const BUILD: Stage = Stage::ACCELERATION_STRUCTURE_BUILD_KHR;
const STRUCTURE_READ: Use = (BUILD, Access::ACCELERATION_STRUCTURE_READ_KHR);
const STRUCTURE_WRITE: Use = (BUILD, Access::ACCELERATION_STRUCTURE_WRITE_KHR);
const COPY: Use = (Stage::COPY, Access::TRANSFER_WRITE);
const CLEAR: Use = (Stage::CLEAR, Access::TRANSFER_WRITE);
/// The kinds that shaders write.
const OUTPUTS: [Kind; 2] = [Kind::Traced, Kind::Computed];

/// Buffers and acceleration structures that no trace or build has used yet: writing them needs no barrier.
static NEW: Mutex<BTreeSet<u64>> = Mutex::new(BTreeSet::new());
/// Buffers used only for copies, which the host maps.
static MAPPED: Mutex<BTreeSet<u64>> = Mutex::new(BTreeSet::new());
/// Buffers that are shader binding tables.
static TABLES: Mutex<BTreeSet<u64>> = Mutex::new(BTreeSet::new());

/// The scratch addresses of builds.
static SCRATCH: Mutex<BTreeSet<u64>> = Mutex::new(BTreeSet::new());

fn locked(set: &Mutex<BTreeSet<u64>>) -> MutexGuard<'_, BTreeSet<u64>> {
    set.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Records a new buffer, which may have the handle of an older one.
pub fn made(buffer: vk::Buffer, usage: Usage) {
    locked(&NEW).insert(buffer.as_raw());
    let is_mapped = (Usage::TRANSFER_SRC | Usage::TRANSFER_DST).contains(usage);
    let is_table = usage.contains(Usage::SHADER_BINDING_TABLE_KHR);
    for (set, is) in [(&MAPPED, is_mapped), (&TABLES, is_table)] {
        if is {
            locked(set).insert(buffer.as_raw());
        } else {
            locked(set).remove(&buffer.as_raw());
        }
    }
}

/// Records a copy to, or an update of, a buffer.
fn fills(command: &str, buffer: vk::Buffer) {
    let is_in = |set| locked(set).contains(&buffer.as_raw());
    if is_in(&MAPPED) {
        // For the host, the program waits on a fence.
        return order::writes(Kind::ReadBack, COPY);
    }
    let kind = if is_in(&TABLES) { Kind::Tables } else { Kind::Filled };
    if !is_in(&NEW) {
        order::waits(command, kind, COPY.0);
    }
    order::writes(kind, COPY);
}

pub unsafe extern "system" fn create_structure(
    device: vk::Device,
    info: *const vk::AccelerationStructureCreateInfoKHR,
    allocator: *const vk::AllocationCallbacks,
    structure: *mut vk::AccelerationStructureKHR,
) -> vk::Result {
    // SAFETY: the arguments are the caller's, here and in every function below.
    unsafe {
        let create = below::device(device).structures.create_acceleration_structure_khr;
        let result = create(device, info, allocator, structure);
        locked(&NEW).insert((*structure).as_raw());
        result
    }
}

pub unsafe extern "system" fn build(
    commands: vk::CommandBuffer,
    count: u32,
    infos: *const vk::AccelerationStructureBuildGeometryInfoKHR,
    ranges: *const *const vk::AccelerationStructureBuildRangeInfoKHR,
) {
    const NAME: &str = "vkCmdBuildAccelerationStructuresKHR";
    // SAFETY: as above; there are `count` infos.
    let own = unsafe { std::slice::from_raw_parts(infos, count as usize) };
    if own.iter().any(|info| !locked(&NEW).contains(&info.dst_acceleration_structure.as_raw())) {
        order::waits(NAME, Kind::Built, BUILD);
    }
    order::reads(NAME, Kind::Filled, (BUILD, Access::SHADER_STORAGE_READ));
    // Vertices and boxes may be computed. Instances never are: the samples copy them.
    let top = vk::AccelerationStructureTypeKHR::TOP_LEVEL;
    if own.iter().any(|info| info.ty != top) {
        order::reads(NAME, Kind::Computed, (BUILD, Access::SHADER_STORAGE_READ));
    }
    if own.iter().any(|info| info.ty == top) {
        order::reads(NAME, Kind::Built, STRUCTURE_READ);
        order::reads(NAME, Kind::Copied, STRUCTURE_READ);
    }
    // SAFETY: both members of the union are addresses of the same size.
    let scratch = own.iter().map(|info| unsafe { info.scratch_data.device_address });
    if scratch.filter(|&address| !locked(&SCRATCH).insert(address)).count() > 0 {
        order::reads(NAME, Kind::Built, STRUCTURE_WRITE);
    }
    order::writes(Kind::Built, STRUCTURE_WRITE);
    locked(&NEW).clear();
    // SAFETY: as above.
    unsafe {
        let below = below::device(commands);
        (below.structures.cmd_build_acceleration_structures_khr)(commands, count, infos, ranges);
    }
}

pub unsafe extern "system" fn copy_structure(
    commands: vk::CommandBuffer,
    info: *const vk::CopyAccelerationStructureInfoKHR,
) {
    order::reads("vkCmdCopyAccelerationStructureKHR", Kind::Built, STRUCTURE_READ);
    order::writes(Kind::Copied, STRUCTURE_WRITE);
    // SAFETY: as above.
    unsafe {
        (below::device(commands).structures.cmd_copy_acceleration_structure_khr)(commands, info);
    }
}

pub unsafe extern "system" fn trace(
    commands: vk::CommandBuffer,
    raygen: *const vk::StridedDeviceAddressRegionKHR,
    miss: *const vk::StridedDeviceAddressRegionKHR,
    hit: *const vk::StridedDeviceAddressRegionKHR,
    callable: *const vk::StridedDeviceAddressRegionKHR,
    width: u32,
    height: u32,
    depth: u32,
) {
    const NAME: &str = "vkCmdTraceRaysKHR";
    let by = |access| (Stage::RAY_TRACING_SHADER_KHR, access);
    for kind in [Kind::Built, Kind::Copied] {
        order::reads(NAME, kind, by(Access::ACCELERATION_STRUCTURE_READ_KHR));
    }
    for kind in [Kind::Filled, Kind::Tables, Kind::Cleared, Kind::Computed, Kind::Traced] {
        order::reads(NAME, kind, by(Access::SHADER_STORAGE_READ));
    }
    order::reads(NAME, Kind::Traced, by(Access::SHADER_STORAGE_WRITE));
    order::writes(Kind::Traced, by(Access::SHADER_STORAGE_WRITE));
    locked(&NEW).clear();
    // SAFETY: as above.
    unsafe {
        let trace = below::device(commands).rays.cmd_trace_rays_khr;
        trace(commands, raygen, miss, hit, callable, width, height, depth);
    }
}

pub unsafe extern "system" fn dispatch(commands: vk::CommandBuffer, x: u32, y: u32, z: u32) {
    const NAME: &str = "vkCmdDispatch";
    let by = |access| (Stage::COMPUTE_SHADER, access);
    order::waits(NAME, Kind::Computed, Stage::COMPUTE_SHADER);
    for kind in [Kind::Filled, Kind::Cleared, Kind::Computed] {
        order::reads(NAME, kind, by(Access::SHADER_STORAGE_READ));
    }
    order::reads(NAME, Kind::Computed, by(Access::SHADER_STORAGE_WRITE));
    if faults::has("queries") {
        for kind in [Kind::Built, Kind::Copied] {
            order::reads(NAME, kind, by(Access::ACCELERATION_STRUCTURE_READ_KHR));
        }
        order::reads(NAME, Kind::Drawn, by(Access::SHADER_STORAGE_READ));
    }
    order::writes(Kind::Computed, by(Access::SHADER_STORAGE_WRITE));
    locked(&NEW).clear();
    // SAFETY: as above.
    unsafe { (below::device(commands).core.fp_v1_0().cmd_dispatch)(commands, x, y, z) }
}

pub unsafe extern "system" fn fill(
    commands: vk::CommandBuffer,
    buffer: vk::Buffer,
    offset: vk::DeviceSize,
    size: vk::DeviceSize,
    data: u32,
) {
    const NAME: &str = "vkCmdFillBuffer";
    if !locked(&NEW).contains(&buffer.as_raw()) {
        order::waits(NAME, Kind::Cleared, CLEAR.0);
        OUTPUTS.into_iter().for_each(|kind| order::reads(NAME, kind, CLEAR));
    }
    order::writes(Kind::Cleared, CLEAR);
    // SAFETY: as above.
    unsafe {
        let fill = below::device(commands).core.fp_v1_0().cmd_fill_buffer;
        fill(commands, buffer, offset, size, data);
    }
}

pub unsafe extern "system" fn update(
    commands: vk::CommandBuffer,
    buffer: vk::Buffer,
    offset: vk::DeviceSize,
    size: vk::DeviceSize,
    data: *const c_void,
) {
    fills("vkCmdUpdateBuffer", buffer);
    // SAFETY: as above.
    unsafe {
        let update = below::device(commands).core.fp_v1_0().cmd_update_buffer;
        update(commands, buffer, offset, size, data);
    }
}

pub unsafe extern "system" fn copy(
    commands: vk::CommandBuffer,
    from: vk::Buffer,
    to: vk::Buffer,
    count: u32,
    regions: *const vk::BufferCopy,
) {
    const NAME: &str = "vkCmdCopyBuffer";
    if !locked(&MAPPED).contains(&from.as_raw()) {
        let read = (Stage::COPY, Access::TRANSFER_READ);
        OUTPUTS.into_iter().for_each(|kind| order::reads(NAME, kind, read));
    }
    fills(NAME, to);
    // SAFETY: as above.
    unsafe {
        let copy = below::device(commands).core.fp_v1_0().cmd_copy_buffer;
        copy(commands, from, to, count, regions);
    }
}

pub unsafe extern "system" fn copy_from_image(
    commands: vk::CommandBuffer,
    image: vk::Image,
    layout: vk::ImageLayout,
    buffer: vk::Buffer,
    count: u32,
    regions: *const vk::BufferImageCopy,
) {
    fills("vkCmdCopyImageToBuffer", buffer);
    // SAFETY: as above.
    unsafe {
        let copy = below::device(commands).core.fp_v1_0().cmd_copy_image_to_buffer;
        copy(commands, image, layout, buffer, count, regions);
    }
}

pub unsafe extern "system" fn clear_image(
    commands: vk::CommandBuffer,
    image: vk::Image,
    layout: vk::ImageLayout,
    color: *const vk::ClearColorValue,
    count: u32,
    ranges: *const vk::ImageSubresourceRange,
) {
    order::writes(Kind::Cleared, CLEAR);
    // SAFETY: as above.
    unsafe {
        let clear = below::device(commands).core.fp_v1_0().cmd_clear_color_image;
        clear(commands, image, layout, color, count, ranges);
    }
}

pub unsafe extern "system" fn end(commands: vk::CommandBuffer) -> vk::Result {
    order::reads("the host", Kind::ReadBack, (Stage::HOST, Access::HOST_READ));
    // SAFETY: as above.
    unsafe { (below::device(commands).core.fp_v1_0().end_command_buffer)(commands) }
}
