// What the shaders of this chapter share: the push constants, and what the pipeline is made for.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/plane.glsl"
#include "board.glsl"
#include "common/show.glsl"

// What is in the world beside the scene. It would not fit into push constants: 128 bytes are all that
// every device has.
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
