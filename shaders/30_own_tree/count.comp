#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "sort.glsl"

// The first of three parts of a step: how often each digit is in each share.

shared uint counts[DIGITS];

void main() {
    const uint self = gl_LocalInvocationIndex;
    for (uint d = self; d < DIGITS; d += WIDTH) {
        counts[d] = 0;
    }
    barrier();
    for (uint i = share_begin() + self; i < share_end(); i += WIDTH) {
        atomicAdd(counts[digit(push.keys.at[i])], 1);
    }
    barrier();
    for (uint d = self; d < DIGITS; d += WIDTH) {
        push.counts.at[gl_WorkGroupID.x * DIGITS + d] = counts[d];
    }
}
