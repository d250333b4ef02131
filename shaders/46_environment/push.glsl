// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/pixel_sum.glsl"
#include "common/rough.glsl"
#include "common/sky.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    RoughAddresses rough;
    SkyAddresses sky;
    Sums sums;
    float rotation;       // of the sky around the vertical, in turns
    uint depth;           // how often a path may be reflected
    float most;           // what a hit or the sky may add after the first ray; 0 for whatever it brings
    uint seed;
    uint sample_index;    // which of a pixel's samples
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_RAYS = 1;

layout(constant_id = 1) const uint SAMPLER = 0;
const uint SAMPLER_BOUNCES = 0;
const uint SAMPLER_UNIFORM = 1;
const uint SAMPLER_MAP = 2;
const uint SAMPLER_BOTH = 3;

// The camera and a mirror leave no choice: no shadow ray could have gone there.
const float NO_OTHER = -1.0;

// The purpose of numbers that earlier chapters do not have.
const uint DIMENSION_POINT = 5;

// The best of 45's choices.
const uint SAMPLING = 2;
const uint SAMPLING_DISTRIBUTION = 0;
const uint SAMPLING_BOUNDED = 2;
const uint FORM = 1;
const uint FORM_TEXTBOOK = 0;
const bool COMPENSATION = true;
