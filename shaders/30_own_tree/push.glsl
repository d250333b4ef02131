// What the shaders of this chapter share: the push constants, and what the pipeline is made for.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "constants.glsl"
#include "tree.glsl"

// The pixels of a dispatch.
struct Band {
    uvec2 first;
    uvec2 size;
};

// What a view shows.
struct View {
    vec2 pixel;           // whose ray is walked, as parts of the picture's sides
    uint step;            // after how many nodes
    float size;           // the boxes with a longest side from this size to twice as much
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    AllTrees trees;
    View view;
    Band band;
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
const uint SHOW_STEPS = 7;
const uint SHOW_DEPTH = 8;
const uint SHOW_BOXES = 9;
const uint SHOW_WALK = 10;
