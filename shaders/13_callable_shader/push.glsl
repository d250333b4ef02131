// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

// The look of a material.
struct Finish {
    vec3 first;
    float scale;      // cells of the lattice per unit
    vec3 second;
    uint pattern;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Finishes { Finish at[]; };

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Finishes finishes;
    Light light;
    uint far;         // how far along x patterns are moved, in cells
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_WEIGHT = 7;
const uint SHOW_OBJECT = 8;

layout(constant_id = 1) const uint CHOOSE = 0;
const uint CHOOSE_CALLABLE = 0;
const uint CHOOSE_SWITCH = 1;
const uint CHOOSE_HIT_GROUP = 2;

layout(constant_id = 2) const uint STAGE = 0;
const uint STAGE_RAYGEN = 0;
const uint STAGE_HIT = 1;

// The first callable shader of a light: those of patterns stand before it.
const uint LIGHTS = 3;
