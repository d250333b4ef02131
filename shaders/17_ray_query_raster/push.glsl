// The push constants and the specialization constants of this chapter's compute shader.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/random.glsl"
#include "common/false_color.glsl"
#include "placed.glsl"

// The pixels of a dispatch.
struct Band {
    uvec2 first;
    uvec2 size;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Placements placed;
    DirectionalLight light;
    uint occlusion_rays;
    Band band;
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_TRIANGLE = 1;
const uint SHOW_WEIGHTS = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_OCCLUSION = 6;

layout(constant_id = 1) const uint PRIMARY = 0;
const uint PRIMARY_RASTER = 0;
const uint PRIMARY_RAYS = 1;
