// What the shaders of this chapter share: the push constants and what `show` may be.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/random.glsl"

// A surface that a ray crossed, in the list of all.
struct Hit {
    uint instance;
    uint triangle;
    float t;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Hits { Hit at[]; };

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    uint show;
    uint mode;
    float opacity;       // of the pieces, in the random modes
    uint samples;        // rays a pixel, in the random modes
    uint invocations;    // how often a decision is made, as if the device called so often
    uint layer;
    Hits hits;           // MAX_HITS for each pixel
} push;

const uint MODE_OPAQUE = 0;
const uint MODE_CUTOUT = 1;
const uint MODE_RANDOM = 2;
const uint MODE_NAIVE = 3;
const uint MODE_ALL_HITS = 4;

const uint MAX_HITS = 32;

struct Payload {
    vec4 color;
    uint sample_index;
    uint state;          // of the naive random numbers
    uint count;          // of the hits that were listed
};

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
