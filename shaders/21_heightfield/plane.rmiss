#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/start.glsl"
#include "lighting.glsl"
#include "common/board.glsl"

// ANCHOR: main
// From the plane a ray needs no care: it is not tested against the plane again, and what stands there
// lies to one side of it.
Start start_from(Met met, vec3 direction) {
    return Start(met.position, 0.0);
}

// The ray met nothing before the plane: it meets the plane.
void main() {
    shade_plane();
}
// ANCHOR_END: main
