// Of no chapter: what --samples runs after each frame. Adds the picture, one sample of each pixel, to the
// sums of all samples.
#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "common/sum.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;

layout(set = 0, binding = 0, rgba32f) uniform readonly image2D picture;

// First of samples that cannot be added: their number in 64 bits, and the complement of the first pixel
// that has one. Then four sums a pixel.
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Sums { uvec4 at[]; };

layout(push_constant, scalar) uniform Push {
    Sums sums;
    uvec2 size;
} push;

void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(id, push.size))) {
        return;
    }
    vec4 color = imageLoad(picture, ivec2(id));
    uint pixel = id.y * push.size.x + id.x;
    Sums sums = push.sums;
    if (!(is_addable(color.r) && is_addable(color.g) && is_addable(color.b) && is_addable(color.a))) {
        if (atomicAdd(sums.at[0].x, 1u) == 0xffffffffu) {
            atomicAdd(sums.at[0].y, 1u);
        }
        atomicMax(sums.at[0].z, ~pixel);
        return;
    }
    for (uint channel = 0; channel < 4; channel++) {
        uvec4 sum = sums.at[1 + 4 * pixel + channel];
        add_to_sum(sum, color[channel]);
        sums.at[1 + 4 * pixel + channel] = sum;
    }
}
