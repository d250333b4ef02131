// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "mover.glsl"
#include "common/show.glsl"

// The number of calls of the intersection shader.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Calls { uint count; };

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Movers movers;
    Calls calls;
    DirectionalLight light;
    uint samples;    // of a pixel
    uint moments;    // that what moves is there for
    uint frame;      // of the game
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_SMEAR = 7;

layout(constant_id = 1) const uint TIMES = 2;
const uint TIMES_MIDDLE = 0;
const uint TIMES_RANDOM = 1;
const uint TIMES_STRATA = 2;

layout(constant_id = 2) const uint METHOD = 1;
const uint METHOD_MOMENTS = 0;
const uint METHOD_SWEPT = 1;

layout(constant_id = 4) const uint COUNTING = 0;
const uint COUNTING_OFF = 0;
const uint COUNTING_ON = 1;

// The bit of the custom index that marks a moving instance.
const uint UNDER_WAY = 0x800000;
// The hit kind of a triangle that the intersection shader has moved.
const uint HIT_MOVED = 1;
