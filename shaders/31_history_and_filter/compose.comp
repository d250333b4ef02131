#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute.glsl"
#include "common/scene.glsl"
#include "common/seen.glsl"
#include "views.glsl"

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;

layout(push_constant, scalar) uniform Compose {
    SceneAddresses scene;
    PixelAddresses pixels;
    Estimates from;
    uint memory;
} push;

// The picture: the light, times the colour of the surface, and what the surface shines with.
void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(id, push.pixels.size)) || is_of_history()) {
        return;    // the last workgroups reach beyond the picture
    }
    uint index = id.y * push.pixels.size.x + id.x;
    Seen surface = push.pixels.surfaces.at[index];
    Estimate estimate = push.from.at[index];
    vec3 shines = vec3(0.0);
    if (instance_of(surface) != NOTHING) {
        shines = push.scene.materials.at[push.scene.instances.at[instance_of(surface)].material].emission;
    }
    vec3 shown = SHOW == SHOW_LIGHT ? estimate.light
        : SHOW == SHOW_LENGTH ? vec3(float(length_of(surface)) / float(push.memory))
        : SHOW == SHOW_DEVIATION ? vec3(sqrt(estimate.square))
        : estimate.light * unpacked_color(push.pixels.colors.at[index]) + shines;
    imageStore(picture, ivec2(id), vec4(shown, 1.0));
}
