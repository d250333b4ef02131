// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/false_color.glsl"
#include "common/plane.glsl"
#include "board.glsl"
#include "common/show.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Reflections { vec3 at[]; };

// The world beside the scene. It does not fit into push constants, for which every device has
// 128 bytes.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer World {
    Reflections reflections;   // of each material, looked at straight
    Plane plane;
    Board board;
    uint light_count;
    Light lights[2];
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    World world;
    uint depth;           // how often a path may be reflected
    float minimum_contribution;
} push;

// The time of the plane's test: before the trace or after it.
layout(constant_id = 1) const uint PLANE_TEST = 0;
const uint TEST_BEFORE = 0;
const uint TEST_AFTER = 1;

layout(constant_id = 2) const bool HAS_PLANE = true;

layout(constant_id = 3) const uint INSIDE = 0;
const uint INSIDE_SURFACE = 0;   // seen from both sides
const uint INSIDE_COLOR = 1;     // shines from inside in a colour of its own
const uint INSIDE_THROUGH = 2;   // seen from outside only
