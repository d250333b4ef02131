// The camera's lens: whatever is not in its focus is blurred (chapter 28).
#include "ray.glsl"
#include "opening.glsl"

const uint DIMENSION_LENS = 5;

// ANCHOR: lens
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
