// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/heightfield.glsl"
#include "common/show.glsl"

// A landscape in a box.
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Ground {
    HeightfieldShape shape;
    vec3 low;            // corners of the box
    vec3 high;
    float error;         // by how much a height above the ground may be wrong, computed in the box
    uint material;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Ground ground;
    DirectionalLight light;
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_STEPS = 7;
const uint SHOW_ERROR = 8;
const uint SHOW_MARCH = 9;

layout(constant_id = 1) const uint RUNG = HEIGHTFIELD_BISECTED;
