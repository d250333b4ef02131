// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/plane.glsl"
#include "board.glsl"
#include "common/show.glsl"

// The world beside the scene. It does not fit into push constants, for which every device has
// 128 bytes.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer World {
    Plane plane;
    Board board;
    DirectionalLight light;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    World world;
    uint depth;           // how often a path may be reflected
    float minimum_contribution;
} push;
