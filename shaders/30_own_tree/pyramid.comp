#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "bounds.glsl"
#include "index.glsl"

// Boxes around pairs of boxes, around pairs of those, and so on: a level lies behind the one below it, and has half as
// many. Three levels a dispatch, since no invocation needs what another one makes.

layout(push_constant, scalar) uniform Level {
    Boxes boxes;    // of the level below
    uint count;     // of these
} push;

void main() {
    uint i = invocation();
    uint first = 0, count = push.count;
    for (uint pairs = 4; pairs > 0 && count > 1; pairs /= 2) {
        uint above = first + count;
        for (uint k = i * pairs; k < (i + 1) * pairs && 2 * k < count; k++) {
            Bounds box = push.boxes.at[first + 2 * k];
            if (2 * k + 1 < count) {
                box = around(box, push.boxes.at[first + 2 * k + 1]);
            }
            push.boxes.at[above + k] = box;
        }
        first = above;
        count = (count + 1) / 2;
    }
}
