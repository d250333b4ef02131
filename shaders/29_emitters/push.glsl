// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/pixel_sum.glsl"
#include "common/emitter_list.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    EmitterAddresses emitters;
    Sums sums;
    uint depth;           // how often light may be reflected on its way to the eye
    float most;           // what a hit or the sky may add after the first ray; 0 for whatever it brings
    uint seed;
    uint sample_index;    // which of a pixel's samples
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_RAYS = 1;

layout(constant_id = 1) const uint SKY = 0;
const uint SKY_NIGHT = 0;
const uint SKY_DAY = 1;
const uint SKY_BLACK = 2;

layout(constant_id = 2) const uint ESTIMATOR = 0;
const uint ESTIMATOR_BSDF = 0;
const uint ESTIMATOR_LIGHT = 1;
const uint ESTIMATOR_MIS = 2;

layout(constant_id = 3) const uint CHOICE = 0;
const uint CHOICE_ONE = 0;
const uint CHOICE_ALL = 1;
const uint CHOICE_POWER = 2;

layout(constant_id = 4) const uint TRIANGLES = 0;
const uint TRIANGLES_AREA = 0;
const uint TRIANGLES_SOLID_ANGLE = 1;
#define ALL_BY_AREA (TRIANGLES == TRIANGLES_AREA)
