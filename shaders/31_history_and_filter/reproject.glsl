// The place of a surface in the last frame's picture.

// ANCHOR: reproject
// The rigid motion that takes a piece from where it is to where it was: the columns of a matrix.
struct Back {
    vec3 x;
    vec3 y;
    vec3 z;
    vec3 origin;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Backs { Back at[]; };

// The point of a picture, in pixels, where a camera sees a point of the world. False if it lies behind the camera.
bool project(CameraBasis camera, vec3 world, uvec2 size, out vec2 point) {
    vec3 from_eye = world - camera.origin;
    float depth = dot(from_eye, camera.forward);
    vec2 side = vec2(dot(from_eye, camera.right), -dot(from_eye, camera.up));
    vec2 scale = vec2(dot(camera.right, camera.right), dot(camera.up, camera.up));
    point = (0.5 + 0.5 * side / (scale * depth)) * vec2(size);
    return depth > 0.0;
}
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
