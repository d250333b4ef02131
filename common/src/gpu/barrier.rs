//! Memory barriers, named for what they are for.
//!
//! Each says which writes it makes visible to which reads (Vulkan specification, "Synchronization"). The validation
//! layers do not see most hazards around traces and builds; the tests' layer `minimum_limits` does.

use ash::vk::{self, AccessFlags2 as Access, PipelineStageFlags2 as Stage};

use super::Gpu;

fn memory(gpu: &Gpu, cmd: vk::CommandBuffer, from: (Stage, Access), to: (Stage, Access)) {
    // Without any ray tracing feature, nothing builds or traces, and no barrier may name the stages
    // (VUID-VkMemoryBarrier2-srcStageMask-07946 and the like).
    let present = |stages: Stage| {
        if gpu.requirements.has_ray_tracing() {
            stages
        } else {
            stages & !(BUILD | Stage::RAY_TRACING_SHADER_KHR)
        }
    };
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(present(from.0))
        .src_access_mask(from.1)
        .dst_stage_mask(present(to.0))
        .dst_access_mask(to.1)];
    let dependency = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: cmd is being recorded on this device, with synchronization2 enabled.
    unsafe { gpu.device.cmd_pipeline_barrier2(cmd, &dependency) };
}

const BUILD: Stage = Stage::ACCELERATION_STRUCTURE_BUILD_KHR;
/// The stages that trace rays: ray tracing pipelines, and compute shaders with ray queries.
const TRACE: Stage =
    Stage::from_raw(Stage::RAY_TRACING_SHADER_KHR.as_raw() | Stage::COMPUTE_SHADER.as_raw());
/// Transfers that clear, fill or update a buffer or an image.
const FILL: (Stage, Access) =
    (Stage::from_raw(Stage::CLEAR.as_raw() | Stage::COPY.as_raw()), Access::TRANSFER_WRITE);
/// Shader access that adds to a buffer or an image.
const STORAGE: Access =
    Access::from_raw(Access::SHADER_STORAGE_READ.as_raw() | Access::SHADER_STORAGE_WRITE.as_raw());

/// Uploaded bytes become visible to builds (vertices, instances) and to every shader.
pub fn after_upload(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let readers = Stage::ALL_COMMANDS;
    memory(gpu, cmd, (Stage::COPY, Access::TRANSFER_WRITE), (readers, Access::MEMORY_READ));
}

/// A built acceleration structure and its scratch may be read and written by the next build: a bottom level by its
/// top level, a scratch buffer by its next user.
pub fn between_builds(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let both = Access::ACCELERATION_STRUCTURE_READ_KHR | Access::ACCELERATION_STRUCTURE_WRITE_KHR;
    memory(gpu, cmd, (BUILD, both), (BUILD, both));
}

/// A built acceleration structure becomes visible to rays.
pub fn build_to_trace(gpu: &Gpu, cmd: vk::CommandBuffer) {
    // Without ray queries no compute shader may be named as a reader (VUID-VkMemoryBarrier2-dstAccessMask-06256).
    let tracers =
        if gpu.requirements.has_ray_query() { TRACE } else { Stage::RAY_TRACING_SHADER_KHR };
    let written = (BUILD, Access::ACCELERATION_STRUCTURE_WRITE_KHR);
    memory(gpu, cmd, written, (tracers, Access::ACCELERATION_STRUCTURE_READ_KHR));
}

/// The output of a trace (an accumulation buffer, a list of hits) becomes visible to the next.
pub fn trace_to_trace(gpu: &Gpu, cmd: vk::CommandBuffer) {
    memory(gpu, cmd, (TRACE, Access::SHADER_STORAGE_WRITE), (TRACE, STORAGE));
}

/// The output of compute shaders becomes visible to the next compute shader, which may also overwrite their input:
/// the passes of a computation, on any device, with or without ray tracing.
pub fn pass_to_pass(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let written = (Stage::COMPUTE_SHADER, Access::SHADER_STORAGE_WRITE);
    memory(gpu, cmd, written, (Stage::COMPUTE_SHADER, STORAGE));
}

/// Earlier traces finish reading and writing a buffer before a transfer clears it.
pub fn trace_to_fill(gpu: &Gpu, cmd: vk::CommandBuffer) {
    memory(gpu, cmd, (TRACE, Access::SHADER_STORAGE_WRITE), FILL);
}

/// A buffer cleared or filled by a transfer becomes visible to the trace that adds to it.
pub fn fill_to_trace(gpu: &Gpu, cmd: vk::CommandBuffer) {
    memory(gpu, cmd, FILL, (TRACE, STORAGE));
}

/// Earlier traces finish reading an acceleration structure before a build or an update changes it.
pub fn trace_to_build(gpu: &Gpu, cmd: vk::CommandBuffer) {
    // The build does not read anything written before: an execution dependency is enough.
    memory(gpu, cmd, (TRACE, Access::NONE), (BUILD, Access::ACCELERATION_STRUCTURE_WRITE_KHR));
}

/// Earlier traces and builds finish reading vertices before a compute shader moves them.
pub fn trace_to_deform(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let written = Access::SHADER_STORAGE_WRITE;
    memory(gpu, cmd, (TRACE | BUILD, Access::NONE), (Stage::COMPUTE_SHADER, written));
}

/// Vertices moved by a compute shader become visible to builds, which read their input as shader reads, and to the
/// hit shaders of later traces.
pub fn deform_to_build(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let written = (Stage::COMPUTE_SHADER, Access::SHADER_STORAGE_WRITE);
    memory(gpu, cmd, written, (BUILD | TRACE, Access::SHADER_READ));
}

/// Earlier traces and builds finish reading a buffer before a recorded update changes it.
pub fn reads_to_update(gpu: &Gpu, cmd: vk::CommandBuffer) {
    // The update does not read anything written before: an execution dependency is enough.
    memory(gpu, cmd, (TRACE | BUILD, Access::NONE), FILL);
}

/// A recorded update of a buffer becomes visible to the traces and builds that read it.
pub fn update_to_reads(gpu: &Gpu, cmd: vk::CommandBuffer) {
    memory(gpu, cmd, FILL, (TRACE | BUILD, Access::SHADER_READ));
}

/// Earlier traces finish using the shader binding table before a transfer changes it.
pub fn trace_to_table_update(gpu: &Gpu, cmd: vk::CommandBuffer) {
    // The transfer does not read anything written before: an execution dependency is enough.
    memory(gpu, cmd, (TRACE, Access::NONE), (Stage::ALL_TRANSFER, Access::TRANSFER_WRITE));
}

/// A transfer's change of the shader binding table becomes visible to traces: to the device that reads handles as
/// well as to shaders that read a record's data.
pub fn table_update_to_trace(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let written = (Stage::ALL_TRANSFER, Access::TRANSFER_WRITE);
    memory(gpu, cmd, written, (TRACE, Access::SHADER_READ));
}

/// Shader writes become visible to a copy.
pub fn before_readback(gpu: &Gpu, cmd: vk::CommandBuffer) {
    let writers = Stage::ALL_COMMANDS;
    memory(gpu, cmd, (writers, Access::MEMORY_WRITE), (Stage::COPY, Access::TRANSFER_READ));
}

/// A copy into mapped memory becomes visible to the host.
pub fn after_readback(gpu: &Gpu, cmd: vk::CommandBuffer) {
    memory(gpu, cmd, (Stage::COPY, Access::TRANSFER_WRITE), (Stage::HOST, Access::HOST_READ));
}
