// What the shaders of this chapter share: the push constants, and what the pipeline is made for.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/heightfield.glsl"

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

// What is fixed when the pipeline is made: code that cannot run is not even there.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_ORIGIN = 6;
const uint SHOW_STEPS = 7;
const uint SHOW_ERROR = 8;
const uint SHOW_MARCH = 9;

layout(constant_id = 1) const uint RUNG = HEIGHTFIELD_BISECTED;
