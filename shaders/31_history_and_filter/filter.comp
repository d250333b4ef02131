#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute.glsl"
#include "common/seen.glsl"
#include "alike.glsl"

layout(push_constant, scalar) uniform Filter {
    Eye eye;
    PixelAddresses pixels;
    Estimates from;
    Estimates to;
    uint apart;       // the distance of the pixels that count, in pixels
} push;

// The weights of a row, from the middle: those of a quadratic spline.
const float KERNEL[3] = float[](0.375, 0.25, 0.0625);

// ANCHOR: filter
// One pass: 24 pixels around this one move its light towards theirs, each by a weight that is the same in the other
// direction. So what one gains another loses: the sum of all light stays the same, before colours are multiplied.
void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    uvec2 size = push.pixels.size;
    if (any(greaterThanEqual(id, size))) {
        return;    // the last workgroups reach beyond the picture
    }
    uint index = id.y * size.x + id.x;
    Seen here = push.pixels.surfaces.at[index];
    Estimate center = push.from.at[index];
    vec3 moved = vec3(0.0);
    float variance = 0.0;
    float left = 1.0;
    for (int y = -2; y <= 2; y++) {
        for (int x = -2; x <= 2; x++) {
            ivec2 at = ivec2(id) + int(push.apart) * ivec2(x, y);
            bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(size)));
            if (x == 0 && y == 0 || !inside) {
                continue;
            }
            uint other = uint(at.y) * size.x + uint(at.x);
            Estimate there = push.from.at[other];
            float weight = KERNEL[abs(x)] * KERNEL[abs(y)]
                * alike(push.eye, here, push.pixels.surfaces.at[other], float(push.apart) * length(vec2(x, y)));
            // The variance of the difference is the sum of both. The scale is three standard deviations: noise seldom
            // makes a larger difference, so that one is an edge.
            float difference = luminance(there.light) - luminance(center.light);
            float scale = max(9.0 * (center.square + there.square), 1e-20);
            weight *= exp(-0.5 * difference * difference / scale);
            moved += weight * (there.light - center.light);
            variance += weight * weight * there.square;
            left -= weight;
        }
    }
    push.to.at[index] = Estimate(center.light + moved, variance + left * left * center.square);
}
// ANCHOR_END: filter
