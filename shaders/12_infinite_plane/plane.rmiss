#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define NO_TRIANGLE
#include "push.glsl"
#include "lighting.glsl"

// The ray met nothing before the plane: it meets the plane.
void main() {
    shade_plane();
}
