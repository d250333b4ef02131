//! Drawing for a compute shader that reads the result, as tracked by [`order`].
//!
//! A window's panel draws last, to an image of the window: the validation layer checks that.

use ash::vk::{self, AccessFlags2 as Access, PipelineStageFlags2 as Stage};
use layer::below;

use crate::faults;
use crate::order::{self, Kind};

const OUTPUT: Stage = Stage::COLOR_ATTACHMENT_OUTPUT;

pub unsafe extern "system" fn begin(commands: vk::CommandBuffer, info: *const vk::RenderingInfo) {
    if faults::has("queries") {
        order::waits("vkCmdBeginRendering", Kind::Drawn, OUTPUT);
        order::writes(Kind::Drawn, (OUTPUT, Access::COLOR_ATTACHMENT_WRITE));
    }
    // SAFETY: the arguments are the caller's, here and below.
    unsafe { (below::device(commands).core.fp_v1_3().cmd_begin_rendering)(commands, info) }
}

pub unsafe extern "system" fn draw(
    commands: vk::CommandBuffer,
    vertices: u32,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
) {
    if faults::has("queries") {
        let by = (Stage::VERTEX_SHADER, Access::SHADER_STORAGE_READ);
        order::reads("vkCmdDraw", Kind::Filled, by);
    }
    // SAFETY: as above.
    unsafe {
        let draw = below::device(commands).core.fp_v1_0().cmd_draw;
        draw(commands, vertices, instances, first_vertex, first_instance);
    }
}
