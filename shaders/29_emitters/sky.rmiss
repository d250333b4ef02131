#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

// The ray hit nothing: it sees the sky.
void main() {
    hit.t = -1.0;
    vec3 day = sky(gl_WorldRayDirectionEXT);
    hit.color = SKY == SKY_DAY ? day : SKY == SKY_NIGHT ? vec3(0.02, 0.035, 0.08) * day : vec3(0.0);
}
