// What the shaders of this chapter share: the push constants and what `show` may be.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    uint show;
    uint sequence;
    uint scrambling;
    uint pixel_filter;
    uint seed;
    uint frame;           // since anything changed: which point of the sequence
    uint accumulated;     // how many frames are in the mean
} push;

const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;

// A colour that differs from number to number (the finaliser of a 32-bit murmur hash).
vec3 false_color(uint number) {
    number = (number ^ (number >> 16)) * 0x85ebca6bu;
    number = (number ^ (number >> 13)) * 0xc2b2ae35u;
    number ^= number >> 16;
    return vec3(number & 0xffu, (number >> 8) & 0xffu, (number >> 16) & 0xffu) / 255.0;
}
