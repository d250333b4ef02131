// What the shaders of this chapter share: the push constants and what `show` may be.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/random.glsl"

// ANCHOR: record
// What a piece has of its own, at its custom index.
struct PieceRecord {
    mat3 inverse;         // of its matrix without the translation, made in 64 bits
    vec3 at;              // the translation
    uint mesh;            // which of scene.instances
    uint material;
    float tone;           // multiplies the base colour
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Pieces { PieceRecord at[]; };
// ANCHOR_END: record

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Pieces pieces;
    Light light;
    uint light_samples;   // shadow rays a hit, where the light has a size
    uint shadow_rays;
    uint smooth_terminator;
    uint show;
    uint camera_mask;
    uint shadow_mask;
    uint culling;
    uint normals;
    uint object_ray;
    uint first_column;    // of the part of the picture that is traced
} push;

const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_ORIGIN = 6;
const uint SHOW_OBJECT_NORMAL = 7;
const uint SHOW_OBJECT_ORIGIN = 8;

const uint SHADOW_FIRST_HIT = 0;
const uint SHADOW_NEAREST_HIT = 1;
const uint SHADOW_OFF = 2;

const uint CULL_BACK = 1;
const uint CULL_FRONT = 2;

const uint NORMALS_MATRIX = 0;
const uint NORMALS_DEVICE_INVERSE = 1;

const uint OBJECT_RAY_DEVICE = 0;
const uint OBJECT_RAY_MATRIX = 1;

// A colour that differs from number to number (the finaliser of a 32-bit murmur hash).
vec3 false_color(uint number) {
    number = (number ^ (number >> 16)) * 0x85ebca6bu;
    number = (number ^ (number >> 13)) * 0xc2b2ae35u;
    number ^= number >> 16;
    return vec3(number & 0xffu, (number >> 8) & 0xffu, (number >> 16) & 0xffu) / 255.0;
}
