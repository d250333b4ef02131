// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/disk.glsl"
#include "common/pixel_sum.glsl"
#include "common/glass.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Glasses { Glass at[]; };

// The values that stay the same while samples are added up.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer World {
    SceneAddresses scene;
    Glasses glasses;      // one for each material
    Sums sums;
    DiskLight light;
    uint media[4];        // the bodies that the camera is in
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    World world;
    uint depth;           // how many surfaces a path may leave
    float most;           // what a hit or the sky may add after the first ray; 0 for whatever it brings
    uint seed;
    uint sample_index;    // which of a pixel's samples
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_ORIGIN = 1;
const uint SHOW_DIRECTION = 2;

layout(constant_id = 1) const uint SKY = 0;
const uint SKY_EVENING = 0;
const uint SKY_DAY = 1;
const uint SKY_WHITE = 2;
