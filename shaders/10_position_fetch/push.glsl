// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "attributes.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    Meshes meshes;
} push;

// Fixed when the pipeline is made: code for another view is not even compiled.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_GEOMETRIC = 2;
const uint SHOW_TRIANGLE = 3;
const uint SHOW_HIT = 4;
const uint SHOW_DIRECTION = 5;
const uint SHOW_HIT_POINT = 6;
const uint SHOW_RAY_POINT = 7;

layout(constant_id = 1) const uint POSITIONS = 0;
const uint POSITIONS_STRUCTURE = 0;
const uint POSITIONS_BUFFER = 1;
