// What the shaders of this chapter share: the push constants, and what the pipeline is made for.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    float offset;   // of a shadow ray's start, along the face normal
} push;
