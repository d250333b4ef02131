// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "micromap.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    Micromaps micromaps; // one for each instance
} push;

// True if the any-hit shader reads states before it reads a texture.
layout(constant_id = 1) const bool KNOWN = false;

struct Payload {
    vec4 color;
    uint count;          // of the calls, or of the reads
};

layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_STATES = 5;
const uint SHOW_CALLS = 6;
const uint SHOW_READS = 7;
