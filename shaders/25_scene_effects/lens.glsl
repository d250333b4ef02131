// The camera's lens: whatever is not in its focus is blurred (chapter 28).
#include "ray.glsl"

const uint DIMENSION_LENS = 5;

// ANCHOR: lens
// A point of the opening, which reaches 1 from its middle: each as likely as any other. u is from 0 to 1.
vec2 lens_point(vec2 u, uint blades) {
    const float TURN = 6.283185;
    if (blades < 3) {
        // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
        float angle = TURN * (u.y - 0.5);
        return sqrt(u.x) * vec2(cos(angle), sin(angle));
    }
    // A triangle between two corners of the polygon and its middle.
    float sides = float(blades);
    float side = floor(sides * u.x);
    vec2 angles = TURN * (vec2(side, side + 1.0) / sides - 0.5);
    vec2 corner = vec2(sin(angles.x), cos(angles.x));
    vec2 next = vec2(sin(angles.y), cos(angles.y));
    return sqrt(sides * u.x - side) * mix(corner, next, u.y);
}

// Every point of a thin lens sends what comes from one point of the plane in focus to one point of the
// picture. So the ray begins at any point of it, and meets that plane where the ray through the middle does.
void pass_lens(inout Ray ray, vec2 u) {
    Lens lens = push.world.lens;
    if (lens.diameter == 0.0) {
        return;
    }
    vec2 point = 0.5 * lens.diameter * lens_point(u, lens.blades);
    vec3 aside = point.x * normalize(push.camera.right) + point.y * normalize(push.camera.up);
    vec3 sharp = lens.focus / dot(ray.direction, push.camera.forward) * ray.direction;
    ray.origin += aside;
    ray.direction = normalize(sharp - aside);
}
// ANCHOR_END: lens
