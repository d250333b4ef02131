// Taught by 31_history_and_filter.
//
// The light that the last frame knew of a surface.
#include "common/reproject.glsl"
#include "common/same_surface.glsl"

// The sum over four pixels of the last frame.
struct Found {
    Estimate estimate;
    float frames;              // in their histories
    float weight;
    float refused[REASONS];    // the weight of the pixels that do not count, by reason
};

Found nothing_found() {
    return Found(Estimate(vec3(0.0), 0.0), 0.0, 0.0, float[](0.0, 0.0, 0.0, 0.0, 0.0));
}

// ANCHOR: take
// Takes over a pixel of the last frame, with a weight. Only differences are added: equal light stays equal to the bit.
void take(inout Found found, PixelAddresses pixels, uint index, Seen tap, float weight) {
    Estimate estimate = pixels.last_estimates.at[index];
    if (found.weight == 0.0) {
        found.estimate = estimate;
    }
    found.weight += weight;
    float part = weight / found.weight;
    found.estimate.light += part * (estimate.light - found.estimate.light);
    found.estimate.square += part * (estimate.square - found.estimate.square);
    found.frames += part * (float(length_of(tap)) - found.frames);
}
// ANCHOR_END: take

// ANCHOR: find
// The light that the last frame knew of a surface, which was at a point of its picture. The camera is the last one.
Found find(PixelAddresses pixels, CameraBasis camera, Seen here, vec3 normal, vec2 point, float rounding,
        Tests tests) {
    Found found = nothing_found();
    vec2 corner = floor(point - 0.5);
    vec2 part = point - 0.5 - corner;
    for (uint i = 0; i < 4; i++) {
        uvec2 step = uvec2(i & 1u, i >> 1u);
        ivec2 at = ivec2(corner) + ivec2(step);
        vec2 sides = mix(1.0 - part, part, bvec2(step));
        float weight = sides.x * sides.y;
        if (weight == 0.0) {
            continue;
        }
        uint why = OUTSIDE;
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(pixels.size)))) {
            uint index = uint(at.y) * pixels.size.x + uint(at.x);
            Seen tap = pixels.last_surfaces.at[index];
            vec2 reach = vec2(
                footprint(camera, pixels.size, here.position, normal),
                footprint(camera, pixels.size, tap.position, unpacked(tap.normal)));
            why = reason(here, normal, tap, reach, rounding, tests);
            if (why == KEPT) {
                take(found, pixels, index, tap, weight);
            }
        }
        found.refused[why] += weight;
    }
    return found;
}
// ANCHOR_END: find
