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
#include "choose.glsl"

// The nearest hit; its pattern too, if the hit shader is to ask for it.
void main() {
    report();
    if (STAGE == STAGE_HIT && CHOOSE != CHOOSE_HIT_GROUP) {
        patterned(hit);
    }
}
