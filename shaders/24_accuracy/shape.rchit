#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "query.glsl"

layout(location = 0) rayPayloadInEXT Answer payload;
hitAttributeEXT vec3 normal;

void main() {
    payload.hit = 1;
    payload.t = gl_HitTEXT;
    payload.normal = normal;
}
