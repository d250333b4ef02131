// The push constants of this chapter's shaders, and the values of `show`.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    uint show;
    uint rows;            // of the picture
    uint stride;          // records per geometry: right is RAY_TYPES
} push;

const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_GROUP = 5;
const uint SHOW_RECORD = 6;
const uint SHOW_GEOMETRY = 7;

// Ray types: each geometry has a record for each, in this order.
const uint RAY_TYPES = 2;
const uint RAY_LOOK = 0;
const uint RAY_INSPECT = 1;

// The hit groups of the looks, in the pipeline's order.
const uint GROUP_PLAIN = 0;
const uint GROUP_MARBLE = 1;
const uint GROUP_WOOD = 2;
const uint GROUP_LACQUER = 3;
const uint GROUP_INSPECT = 4;
const vec3 GROUP_COLOR[4] = vec3[](
    vec3(0.80, 0.58, 0.12), vec3(0.75, 0.78, 0.82), vec3(0.42, 0.13, 0.05), vec3(0.03, 0.08, 0.22)
);
