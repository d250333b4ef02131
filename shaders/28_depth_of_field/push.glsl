// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"

struct Lens {
    float radius;           // of the aperture
    float inverse_focus;    // 1 over the distance of the plane in focus, along the view; 0 at infinity
    uint blades;            // of the aperture; with less than 3 it is a disk
    float turn;             // of the blades, as a part of a whole turn
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    Lens lens;
    uint sequence;
    uint scrambling;
    uint pixel_filter;
    uint seed;
    uint frame;           // since anything changed: which point of the sequence
    uint accumulated;     // how many frames are in the mean
} push;

layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_ORIGIN = 4;
const uint SHOW_DIRECTION = 5;

// The method that computes a ray's direction to its point in focus.
layout(constant_id = 1) const uint RUNG = 2;
const uint RUNG_WORLD = 0;
const uint RUNG_EYE = 1;
const uint RUNG_START = 2;
