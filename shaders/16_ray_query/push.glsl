// What the shaders of this chapter share: the push constants, and what the pipeline is made for.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

// The pixels of a dispatch.
struct Band {
    uvec2 first;
    uvec2 size;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    Band band;
} push;
