#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "hit.glsl"
#include "common/place.glsl"
#include "report.glsl"
#include "common/pattern.glsl"
#include "finish.glsl"

// The nearest hit on marble: the record has chosen this shader, and nothing is left to choose.
void main() {
    report();
    Finish finish = push.finishes.at[hit.material];
    mix_colors(hit, finish, marble(finish.scale * hit.object, int(push.far)));
}
