// A thin lens, as in 28: rays start all over it, and those of one point of the picture meet in the plane in focus.
#include "common/aperture.glsl"

struct Lens {
    float radius;           // of the aperture
    float inverse_focus;    // 1 over the distance of the plane in focus, along the view; 0 at infinity
    uint blades;            // of the aperture; with less than 3 it is a disk
    float turn;             // of the blades, as a part of a whole turn
};

// The ray through a place in the picture, in pixels, from a place on the lens.
void through_lens(CameraBasis camera, Lens lens, vec2 point, uvec2 size, vec2 u, out vec3 origin,
        out vec3 direction) {
    vec2 screen = 2.0 * point / vec2(size) - 1.0;
    // To the point in focus, with the distance of its plane as the unit.
    vec3 to_focus = camera.forward + screen.x * camera.right - screen.y * camera.up;
    vec2 unit = lens.blades < 3 ? concentric_point(u) : polygon_point(lens.blades, lens.turn, u);
    vec2 place = lens.radius * unit;
    vec3 offset = place.x * normalize(camera.right) + place.y * normalize(camera.up);
    precise vec3 from = camera.origin + offset;
    // The origin is rounded: this is what it has of the offset.
    precise vec3 moved = from - camera.origin;
    origin = from;
    direction = normalize(to_focus - lens.inverse_focus * moved);
}
