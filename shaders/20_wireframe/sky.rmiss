#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;

// The ray hit nothing: it sees the sky, or white paper.
void main() {
    payload = vec4(SHOW == SHOW_LINES ? vec3(1.0) : sky(gl_WorldRayDirectionEXT), 0.0);
}
