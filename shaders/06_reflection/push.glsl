// What the shaders of this chapter share: the push constants, and what the pipeline is made for.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    uint depth;           // how often a path may be reflected
    float minimum_contribution;
    uint bounce;          // which ray of a path `show` looks at, 0 for the camera's
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
