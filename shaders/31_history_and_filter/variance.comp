#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute.glsl"
#include "common/seen.glsl"
#include "alike.glsl"

layout(push_constant, scalar) uniform Variance {
    Eye eye;
    PixelAddresses pixels;
    Estimates to;
} push;

// The fewest frames whose scatter says something about one pixel.
const uint ENOUGH = 4;

// ANCHOR: variance
// The variance of a pixel's mean. A long history has its own, and the mean over the neighbours is steadier; a short
// one takes the scatter of the neighbours' light (Schied and others 2017).
void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    uvec2 size = push.pixels.size;
    if (any(greaterThanEqual(id, size))) {
        return;    // the last workgroups reach beyond the picture
    }
    uint index = id.y * size.x + id.x;
    Seen here = push.pixels.surfaces.at[index];
    Estimate estimate = push.pixels.estimates.at[index];
    bool long_enough = length_of(here) >= ENOUGH;
    int reach = long_enough ? 1 : 3;
    float weights = 0.0;
    float first = 0.0;     // of a short history, the mean luminance
    float second = 0.0;    // and the mean of its square; of a long one, the mean of the variances
    for (int y = -reach; y <= reach; y++) {
        for (int x = -reach; x <= reach; x++) {
            ivec2 at = ivec2(id) + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(size)))) {
                continue;
            }
            uint other = uint(at.y) * size.x + uint(at.x);
            Seen there = push.pixels.surfaces.at[other];
            uint length_there = length_of(there);
            if (long_enough && length_there < ENOUGH) {
                continue;
            }
            float weight = x == 0 && y == 0 ? 1.0 : alike(push.eye, here, there, length(vec2(x, y)));
            Estimate light = push.pixels.estimates.at[other];
            float bright = luminance(light.light);
            float scatter = max(light.square - bright * bright, 0.0);
            weights += weight;
            first += weight * bright;
            second += weight * (long_enough ? scatter / float(length_there - 1u) : light.square);
        }
    }
    first /= weights;
    second /= weights;
    estimate.square = long_enough ? second : max(second - first * first, 0.0) / float(length_of(here));
    push.to.at[index] = estimate;
}
// ANCHOR_END: variance
