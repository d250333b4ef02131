// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/pixel_sum.glsl"
#include "common/rough.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    RoughAddresses rough;
    Sums sums;
    Light light;
    float light_size;
    uint depth;           // how often a path may be reflected
    float most;           // what a hit or the sky may add after the first ray; 0 for whatever it brings
    uint seed;
    uint sample_index;    // which of a pixel's samples
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_DIRECT = 1;
const uint SHOW_BOUNCED = 2;
const uint SHOW_RAYS = 3;
const uint SHOW_FACETS = 4;

layout(constant_id = 1) const uint SKY = 0;
const uint SKY_DAY = 0;
const uint SKY_WHITE = 1;
const uint SKY_BLACK = 2;

layout(constant_id = 2) const bool ROULETTE = true;

layout(constant_id = 3) const uint SAMPLING = 0;
const uint SAMPLING_DISTRIBUTION = 0;
const uint SAMPLING_VISIBLE = 1;
const uint SAMPLING_BOUNDED = 2;

layout(constant_id = 4) const uint FORM = 0;
const uint FORM_TEXTBOOK = 0;
const uint FORM_STABLE = 1;

layout(constant_id = 5) const bool COMPENSATION = true;
