#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "constants.glsl"
#include "rays.glsl"

layout(location = 0) rayPayloadInEXT Answer answer;

void main() {
    answer.instance = NOTHING;
}
