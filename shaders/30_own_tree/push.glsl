// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "constants.glsl"
#include "tree.glsl"
#include "common/show.glsl"

// The pixels of a dispatch.
struct Band {
    uvec2 first;
    uvec2 size;
};

// The values that a view needs.
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

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_STEPS = 7;
const uint SHOW_DEPTH = 8;
const uint SHOW_BOXES = 9;
const uint SHOW_WALK = 10;
