// The push constants and the specialization constants of the shaders that trace.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/disk.glsl"
#include "common/seen.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    PixelAddresses pixels;
    DiskLight light;
    uint depth;           // how often a path may be reflected
    uint seed;
    uint sample_index;    // which of a pixel's samples
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SKY = 0;
const uint SKY_DAY = 0;
const uint SKY_WHITE = 1;
const uint SKY_BLACK = 2;

layout(constant_id = 1) const bool ROULETTE = true;
layout(constant_id = 2) const bool DIVIDE = true;
