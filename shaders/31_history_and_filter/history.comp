#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute.glsl"
#include "common/camera.glsl"
#include "common/seen.glsl"
#include "common/past_light.glsl"
#include "views.glsl"

layout(constant_id = 3) const bool INSTANCE_TEST = true;
layout(constant_id = 4) const bool PLANE_TEST = true;
layout(constant_id = 5) const bool NORMAL_TEST = true;
layout(constant_id = 6) const bool FOLLOW = true;

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;

layout(push_constant, scalar) uniform History {
    CameraBasis camera;      // of the last frame
    PixelAddresses pixels;
    Backs back;
    uint memory;             // the longest history, in frames
    float rounding;          // a bound on the error of a distance between two points of the scene
} push;

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
        Found found = nothing_found();
        if (!begins) {
            Tests tests = Tests(INSTANCE_TEST, PLANE_TEST, NORMAL_TEST);
            found = find(push.pixels, push.camera, before, normal, point, push.rounding, tests);
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
