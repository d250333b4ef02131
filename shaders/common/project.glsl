// Taught by 31_history_and_filter.
//
// The point of a picture that shows a point of the world: the inverse of camera.glsl.
#include "common/camera.glsl"

// ANCHOR: project
// The point of a picture, in pixels, where a camera sees a point of the world. False if it lies behind the camera.
bool project(CameraBasis camera, vec3 world, uvec2 size, out vec2 point) {
    vec3 from_eye = world - camera.origin;
    float depth = dot(from_eye, camera.forward);
    vec2 side = vec2(dot(from_eye, camera.right), -dot(from_eye, camera.up));
    vec2 scale = vec2(dot(camera.right, camera.right), dot(camera.up, camera.up));
    point = (0.5 + 0.5 * side / (scale * depth)) * vec2(size);
    return depth > 0.0;
}
// ANCHOR_END: project
