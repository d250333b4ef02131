#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute.glsl"
#include "common/camera.glsl"
#include "pixels.glsl"
#include "reproject.glsl"
#include "same_surface.glsl"
#include "views.glsl"

layout(constant_id = 6) const bool FOLLOW = true;

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;

layout(push_constant, scalar) uniform History {
    CameraBasis camera;      // of the last frame
    PixelAddresses pixels;
    Backs back;
    uint memory;             // the longest history, in frames
    float rounding;          // a bound on the error of a distance between two points of the scene
} push;

// The sum over four pixels of the last frame.
struct Found {
    Estimate estimate;
    float frames;              // in their histories
    float weight;
    float refused[REASONS];    // the weight of the pixels that do not count, by reason
};

// ANCHOR: take
// Takes over a pixel of the last frame, with a weight. Only differences are added: equal light stays equal to the bit.
void take(inout Found found, uint index, Seen tap, float weight) {
    Estimate estimate = push.pixels.last_estimates.at[index];
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
// The light that the last frame knew of a surface, which was at a point of its picture.
Found find(Seen here, vec3 normal, vec2 point) {
    Found found = Found(Estimate(vec3(0.0), 0.0), 0.0, 0.0, float[](0.0, 0.0, 0.0, 0.0, 0.0));
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
        if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(push.pixels.size)))) {
            uint index = uint(at.y) * push.pixels.size.x + uint(at.x);
            Seen tap = push.pixels.last_surfaces.at[index];
            vec2 reach = vec2(
                footprint(push.camera, push.pixels.size, here.position, normal),
                footprint(push.camera, push.pixels.size, tap.position, unpacked(tap.normal)));
            why = reason(here, normal, tap, reach, push.rounding);
            if (why == KEPT) {
                take(found, index, tap, weight);
            }
        }
        found.refused[why] += weight;
    }
    return found;
}
// ANCHOR_END: find

// Grey where the history goes on; otherwise a colour for each reason.
vec3 painted(Found found, bool begins) {
    if (begins) {
        return vec3(0.5, 0.2, 0.5);
    }
    return found.refused[KEPT] * vec3(0.08) + found.refused[OUTSIDE] * vec3(0.1, 0.3, 1.0)
        + found.refused[OTHER] * vec3(1.0, 0.15, 0.05) + found.refused[OFF_PLANE] * vec3(1.0, 0.8, 0.1)
        + found.refused[TURNED] * vec3(0.1, 0.8, 0.2);
}

void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(id, push.pixels.size))) {
        return;    // the last workgroups reach beyond the picture
    }
    uint index = id.y * push.pixels.size.x + id.x;
    Seen here = push.pixels.surfaces.at[index];
    vec3 shown = SHOW == SHOW_HIT ? here.position : vec3(0.0);
    if (instance_of(here) != NOTHING) {
        // ANCHOR: before
        // The surface as it was in the last frame.
        Seen before = here;
        vec3 normal = unpacked(here.normal);
        Back back = push.back.at[instance_of(here)];
        mat3 turn = mat3(back.x, back.y, back.z);
        before.position = turn * here.position + back.origin;
        normal = turn * normal;
        vec2 point = vec2(id) + 0.5;
        bool begins = push.memory < 2;
        if (FOLLOW && !begins && !project(push.camera, before.position, push.pixels.size, point)) {
            point = vec2(-2.0);    // behind the camera: outside the picture
        }
        // ANCHOR_END: before
        Found found = Found(Estimate(vec3(0.0), 0.0), 0.0, 0.0, float[](0.0, 0.0, 0.0, 0.0, 0.0));
        if (!begins) {
            found = find(before, normal, point);
        }
        // ANCHOR: mean
        if (found.weight > 0.0) {
            float count = min(round(found.frames) + 1.0, float(push.memory));
            Estimate fresh = push.pixels.estimates.at[index];
            Estimate mean = found.estimate;
            mean.light += (fresh.light - mean.light) / count;
            mean.square += (fresh.square - mean.square) / count;
            push.pixels.estimates.at[index] = mean;
            uint rest = packed_rest(instance_of(here), uint(count), 0.0);
            push.pixels.surfaces.at[index].rest = rest | here.rest & 0xffu;
        }
        // ANCHOR_END: mean
        shown = SHOW == SHOW_REFUSED ? painted(found, begins)
            : SHOW == SHOW_MOVEMENT ? vec3(vec2(id) + 0.5 - point, found.weight) : shown;
    }
    if (is_of_history()) {
        imageStore(picture, ivec2(id), vec4(shown, 1.0));
    }
}
