// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    vec2 size;     // of the picture, in pixels
    float width;   // of a line, in pixels
} push;

// Fixed when the pipeline is made: code for another view is not even compiled.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_LINES = 1;
const uint SHOW_NORMAL = 2;

layout(constant_id = 1) const uint CONSTANT = 0;
const uint CONSTANT_WIDTH = 0;
const uint CONSTANT_WEIGHT = 1;

layout(constant_id = 2) const bool HIDDEN = false;
