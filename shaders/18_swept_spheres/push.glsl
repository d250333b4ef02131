// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/strand.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer StrandAddresses {
    Nodes nodes;
    Segments segments;
    Original ids;   // primitive i of the build is segment ids.at[i]
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    StrandAddresses strands;
    DirectionalLight light;
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_SEGMENT = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_ALONG = 5;

// True to shade by a normal that is perpendicular to the axis, and not to the surface.
layout(constant_id = 1) const uint NORMAL = 0;
const uint NORMAL_SURFACE = 0;
const uint NORMAL_AXIS = 1;
