//! Flags that a program must not use if ray tracing is hidden, and that a validation layer as old as 1.3.239
//! does not detect.

use ash::vk::{self, BufferUsageFlags as Usage, PipelineStageFlags2 as Stage};
use layer::below;

use crate::{commands, faults, order};

/// The buffer usages of ray tracing (VUID-VkBufferCreateInfo-None-09499).
const USAGES: u32 = Usage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR.as_raw()
    | Usage::ACCELERATION_STRUCTURE_STORAGE_KHR.as_raw()
    | Usage::SHADER_BINDING_TABLE_KHR.as_raw();

/// The stages of ray tracing (VUID-VkMemoryBarrier2-srcStageMask-07946, -10751, and those of the other
/// barriers).
const STAGES: u64 =
    Stage::ACCELERATION_STRUCTURE_BUILD_KHR.as_raw() | Stage::RAY_TRACING_SHADER_KHR.as_raw();

pub unsafe extern "system" fn create_buffer(
    device: vk::Device,
    info: *const vk::BufferCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    buffer: *mut vk::Buffer,
) -> vk::Result {
    // SAFETY: the arguments are the caller's.
    unsafe {
        if faults::has("no-ray-tracing") && (*info).usage.as_raw() & USAGES != 0 {
            return vk::Result::ERROR_VALIDATION_FAILED_EXT;
        }
        let create = below::device(device).core.fp_v1_0().create_buffer;
        let result = create(device, info, allocator, buffer);
        commands::made(*buffer, (*info).usage);
        result
    }
}

pub unsafe extern "system" fn barrier(
    commands: vk::CommandBuffer,
    info: *const vk::DependencyInfo,
) {
    // SAFETY: the arguments are the caller's; each list has the given length.
    unsafe {
        let vk::DependencyInfo { memory_barrier_count, p_memory_barriers, .. } = *info;
        for at in 0..memory_barrier_count as usize {
            let one = &*p_memory_barriers.add(at);
            let stages = one.src_stage_mask | one.dst_stage_mask;
            // A barrier cannot fail, so the process ends with the message.
            let hidden = faults::has("no-ray-tracing") && stages.as_raw() & STAGES != 0;
            assert!(!hidden, "a barrier names {stages:?}");
            let from = (one.src_stage_mask, one.src_access_mask);
            order::barrier(from, (one.dst_stage_mask, one.dst_access_mask));
        }
        let vk::DependencyInfo { image_memory_barrier_count, p_image_memory_barriers, .. } = *info;
        for at in 0..image_memory_barrier_count as usize {
            let one = &*p_image_memory_barriers.add(at);
            let from = (one.src_stage_mask, one.src_access_mask);
            order::image_barrier(from, (one.dst_stage_mask, one.dst_access_mask));
        }
        (below::device(commands).core.fp_v1_3().cmd_pipeline_barrier2)(commands, info);
    }
}
