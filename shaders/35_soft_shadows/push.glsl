// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/disk.glsl"
#include "common/random.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DiskLight light;
} push;
