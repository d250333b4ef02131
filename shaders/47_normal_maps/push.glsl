// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/pixel_sum.glsl"
#include "common/rough.glsl"
#include "common/normal_map.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MappedAddresses {
    RoughAddresses rough;
    NormalMaps maps;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    MappedAddresses mapped;
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
const uint SHOW_NORMALS = 1;
const uint SHOW_BELOW = 2;
const uint SHOW_LOST = 3;

layout(constant_id = 1) const uint SKY = 0;
const uint SKY_DAY = 0;
const uint SKY_WHITE = 1;
const uint SKY_BLACK = 2;

layout(constant_id = 2) const bool ROULETTE = true;

layout(constant_id = 3) const uint RULE = 0;
const uint RULE_NONE = 0;
const uint RULE_CUT = 1;
const uint RULE_FLIPPED = 2;
const uint RULE_BENT = 3;
const uint RULE_TWO_FACETS = 4;

// The purposes of numbers that earlier chapters do not have.
const uint DIMENSION_WALL = 5;
const uint DIMENSION_LEAVE = 6;

// The best of 45's choices.
const uint SAMPLING = 2;
const uint SAMPLING_DISTRIBUTION = 0;
const uint SAMPLING_BOUNDED = 2;
const uint FORM = 1;
const uint FORM_TEXTBOOK = 0;
const bool COMPENSATION = true;
