// Taught by 31_history_and_filter.
//
// The place of a surface in the last frame's picture.
#include "common/project.glsl"

// ANCHOR: reproject
// The rigid motion that takes a piece from where it is to where it was: the columns of a matrix.
struct Back {
    vec3 x;
    vec3 y;
    vec3 z;
    vec3 origin;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Backs { Back at[]; };
// ANCHOR_END: reproject

// The distance on a plane between the rays of pixels that are neighbours, one of them across a corner.
float footprint(CameraBasis camera, uvec2 size, vec3 position, vec3 normal) {
    vec3 from_eye = position - camera.origin;
    float apart = 2.0 * length(camera.right) / float(size.x);
    float distance = length(from_eye);
    // A surface seen along itself would have no end.
    float cosine = max(abs(dot(normal, from_eye)) / distance, 1e-4);
    return 1.41421356 * apart * distance / cosine;
}
