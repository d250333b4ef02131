// A thin lens: rays start all over it, and those of one point of the picture meet in the plane in focus.
#include "common/aperture.glsl"

// Two other ways to write the direction to the point in focus. The first ignores where the ray really starts,
// and the second rounds the point.
vec3 coarse_direction(CameraBasis camera, Lens lens, vec3 to_focus, vec3 offset, vec3 origin) {
    if (RUNG == RUNG_EYE) {
        return to_focus - lens.inverse_focus * offset;
    }
    // No point of the world is infinitely far away.
    vec3 focus = camera.origin + to_focus / max(lens.inverse_focus, 1e-18);
    return focus - origin;
}

struct Ray {
    vec3 origin;
    vec3 direction;
};

// The ray through a place in the picture, in pixels, from a place on the lens.
Ray through_lens(CameraBasis camera, Lens lens, vec2 point, uvec2 size, vec2 u) {
    vec2 screen = 2.0 * point / vec2(size) - 1.0;
    // To the point in focus, with the distance of its plane as the unit.
    vec3 to_focus = camera.forward + screen.x * camera.right - screen.y * camera.up;
    vec2 unit = lens.blades < 3 ? concentric_point(u) : polygon_point(lens.blades, lens.turn, u);
    vec2 place = lens.radius * unit;
    vec3 offset = place.x * normalize(camera.right) + place.y * normalize(camera.up);
    precise vec3 origin = camera.origin + offset;
    // The origin is rounded: this is what it has of the offset.
    precise vec3 moved = origin - camera.origin;
    vec3 direction = to_focus - lens.inverse_focus * moved;
    if (RUNG != RUNG_START) {
        direction = coarse_direction(camera, lens, to_focus, offset, origin);
    }
    return Ray(origin, normalize(direction));
}
