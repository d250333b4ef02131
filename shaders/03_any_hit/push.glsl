// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/random.glsl"

// A surface that a ray crossed, in the list of all.
struct ListedHit {
    uint instance;
    uint triangle;
    float t;
};

// The any-hit shader writes to it and the raygen shader reads, within one trace: it has to be coherent.
layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer Hits { ListedHit at[]; };

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    float opacity;       // of the pieces, in the random modes
    uint samples;        // rays per pixel, in the random modes
    uint invocations;    // how often a decision is made, as if the device called so often
    uint layer;
    Hits hits;           // MAX_HITS for each pixel
} push;

layout(constant_id = 1) const uint MODE = 0;
const uint MODE_OPAQUE = 0;
const uint MODE_CUTOUT = 1;
const uint MODE_RANDOM = 2;
const uint MODE_NAIVE = 3;
const uint MODE_ALL_HITS = 4;

const uint MAX_HITS = 32;

struct Payload {
    vec4 color;
    uint pixel;          // column and row, 16 bits each
    uint number;         // of the pixel, row by row
    uint sample_index;
    uint state;          // of the naive random numbers
    uint count;          // of the hits that were listed
};

layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
