// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

// ANCHOR: record
// The data of a piece, at its custom index.
struct PieceRecord {
    mat3 inverse;         // of its matrix without the translation, made in 64 bits
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
    DirectionalLight light;
    uint camera_mask;     // which instances primary rays see
    uint shadow_mask;     // which instances throw shadows
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_INSTANCE_ID = 7;
const uint SHOW_OBJECT_NORMAL = 8;

layout(constant_id = 1) const uint CULLING = 0;
const uint CULL_OFF = 0;
const uint CULL_BACK = 1;
const uint CULL_FRONT = 2;

layout(constant_id = 2) const uint NORMALS = 2;
const uint NORMALS_MATRIX = 0;
const uint NORMALS_DEVICE_INVERSE = 1;
const uint NORMALS_HOST_INVERSE = 2;
