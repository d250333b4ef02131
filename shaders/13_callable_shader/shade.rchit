#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "report.glsl"
#include "choose.glsl"

// Reports the nearest hit, and its pattern if the hit shader is the one to call it.
void main() {
    report();
    if (STAGE == STAGE_HIT && CHOOSE != CHOOSE_HIT_GROUP) {
        patterned(seen);
    }
}
