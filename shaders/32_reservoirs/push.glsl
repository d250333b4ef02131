// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/emitter_list.glsl"
#include "pixels.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;    // of this frame; in time.rgen, of the last one
    SceneAddresses scene;
    EmitterAddresses emitters;
    PixelAddresses pixels;
    uint candidates;       // in a pixel and a frame
    uint most;             // the largest count that a pixel's history may have; 0 if there is none
    uint neighbours;       // that a pixel merges with
    uint radius;           // how far these are, at most, in rows and in columns
    uint seed;
    uint sample_index;     // which of a pixel's frames
    uint frames;           // how many frames are in the means
    float tolerance;       // see alike()
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_MEAN = 1;
const uint SHOW_COUNT = 2;
const uint SHOW_EMITTER = 3;

layout(constant_id = 1) const uint SKY = 0;
const uint SKY_NIGHT = 0;
const uint SKY_DAY = 1;
const uint SKY_BLACK = 2;

layout(constant_id = 2) const uint WEIGHTS = 0;
const uint WEIGHTS_ONE_OVER_M = 0;
const uint WEIGHTS_ONE_OVER_Z = 1;
const uint WEIGHTS_BALANCE = 2;

layout(constant_id = 3) const bool VISIBILITY = true;
layout(constant_id = 4) const bool JITTER = true;
