#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "sort.glsl"

// The second part: how often each digit is in all shares before one, and in all.

void main() {
    uint d = gl_GlobalInvocationID.x;
    uint sum = 0;
    for (uint share = 0; share < push.shares; share++) {
        uint here = push.counts.at[share * DIGITS + d];
        push.counts.at[share * DIGITS + d] = sum;
        sum += here;
    }
    push.totals.at[d] = sum;
}
