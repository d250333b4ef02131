// Taught by 02_basic.
//
// A pinhole camera: the ray of a pixel.

struct CameraBasis {
    vec3 origin;
    vec3 right;   // half the picture's width, at distance 1
    vec3 up;      // half its height
    vec3 forward;
};

// The direction through a point of the picture, in pixels from its top left corner.
vec3 ray_direction(CameraBasis camera, vec2 point, uvec2 size) {
    vec2 screen = 2.0 * point / vec2(size) - 1.0;
    return normalize(camera.forward + screen.x * camera.right - screen.y * camera.up);
}
