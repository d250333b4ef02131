// What the shaders of this chapter share: the push constants and what `show` may be.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/random.glsl"

// ANCHOR: shapes
struct Sphere {
    vec3 center;
    float radius;
    uint material;
};

struct Box {
    vec3 low;
    vec3 high;
    uint material;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Spheres { Sphere at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Boxes { Box at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer HostC { float at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Shapes {
    Spheres spheres;
    Boxes boxes;
    Original sphere_ids;   // primitive i of the build is sphere sphere_ids.at[i]
    Original box_ids;
};
// ANCHOR_END: shapes

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Shapes shapes;
    HostC host_c;         // of each sphere: |camera - center|^2 - radius^2
    Light light;
    uint light_samples;   // shadow rays a hit, where the light has a size
    uint shadow_rays;
    uint smooth_terminator;
    uint show;
} push;

const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_ORIGIN = 6;
const uint SHOW_KIND = 7;

const uint SHADOW_FIRST_HIT = 0;
const uint SHADOW_NEAREST_HIT = 1;
const uint SHADOW_OFF = 2;

// Hit kinds of intersection shaders go from 0 to 127; those of triangles are 254 and 255.
const uint KIND_SPHERE = 0;
const uint KIND_BOX = 1;

// A colour that differs from number to number (the finaliser of a 32-bit murmur hash).
vec3 false_color(uint number) {
    number = (number ^ (number >> 16)) * 0x85ebca6bu;
    number = (number ^ (number >> 13)) * 0xc2b2ae35u;
    number ^= number >> 16;
    return vec3(number & 0xffu, (number >> 8) & 0xffu, (number >> 16) & 0xffu) / 255.0;
}
