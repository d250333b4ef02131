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
} push;

// The height above its surface at which a shadow ray starts.
layout(constant_id = 1) const uint OFFSET = 0;
const uint OFFSET_BOUND = 0;
const uint OFFSET_CONSTANT = 1;
