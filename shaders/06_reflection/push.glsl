// What the shaders of this chapter share: the push constants, what `show` may be, and the path.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/random.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Light light;
    uint light_samples;   // shadow rays a hit, where the light has a size
    uint shadow_rays;
    uint smooth_terminator;
    uint depth;                   // how often a path may be reflected
    float minimum_contribution;
    uint origin;                  // one of the rules of common/origin.glsl
    uint bounce;                  // which ray of a path `show` looks at, 0 for the camera's
    uint show;
} push;

const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_SHADOW_ORIGIN = 6;
const uint SHOW_RAY_ORIGIN = 7;

const uint SHADOW_FIRST_HIT = 0;
const uint SHADOW_NEAREST_HIT = 1;
const uint SHADOW_OFF = 2;

// Compiled in, so that no shader of a loop holds a call to itself.
layout(constant_id = 0) const uint METHOD = 0;
const uint METHOD_ITERATIVE = 0;
const uint METHOD_RECURSIVE = 1;

// ANCHOR: path
// What travels along a path: what it has gathered, and the next ray.
struct Path {
    vec4 color;
    vec3 throughput;   // what part of the light at the end of the next ray reaches the eye
    vec3 origin;
    float tmin;
    vec3 direction;
    uint bounce;       // the ray's number: 0 comes from the camera
};

// Adds what a ray meets. The picture is the sum over the path; every other view shows one ray's.
void gather(inout Path path, vec4 seen) {
    if (push.show == SHOW_PICTURE) {
        path.color += vec4(path.throughput * seen.rgb, path.bounce == 0 ? seen.a : 0.0);
    } else if (path.bounce == push.bounce) {
        path.color = seen;
    }
}

// Whether the next ray is worth tracing.
bool goes_on(Path path) {
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    return path.bounce <= push.depth && contribution > 0.0
        && contribution >= push.minimum_contribution;
}
// ANCHOR_END: path

// A colour that differs from number to number (the finaliser of a 32-bit murmur hash).
vec3 false_color(uint number) {
    number = (number ^ (number >> 16)) * 0x85ebca6bu;
    number = (number ^ (number >> 13)) * 0xc2b2ae35u;
    number ^= number >> 16;
    return vec3(number & 0xffu, (number >> 8) & 0xffu, (number >> 16) & 0xffu) / 255.0;
}
