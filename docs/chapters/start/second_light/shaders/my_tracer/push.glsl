// The push constants of all shaders. The files in `common/` are the book's.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight sun;
    uint reflections;
    float moon;
} push;
