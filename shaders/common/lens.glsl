// Taught by 28_depth_of_field; what 25 has of it: a thin lens, and the most exact of its ways to the point in focus.
//
// Rays start all over a thin lens, and those of one point of the picture meet in the plane in focus.

struct Lens {
    float radius;           // of the aperture
    float inverse_focus;    // 1 over the distance of the plane in focus, along the view; 0 at infinity
    uint blades;            // of the aperture; with less than 3 it is a disk
    float turn;             // of the blades, as a part of a whole turn
};

// ANCHOR: disk
// A square becomes a disk, ring by ring: what is uniform stays uniform, and neighbours stay neighbours
// (Shirley and Chiu 1997).
vec2 disk_point(vec2 u) {
    vec2 place = 2.0 * u - 1.0;
    bool is_wide = abs(place.x) > abs(place.y);
    float radius = is_wide ? place.x : place.y;
    float aside = is_wide ? place.y : place.x;
    // The four sides of a square ring are a quarter of a circle each.
    float angle = radius == 0.0 ? 0.0 : 0.7853981 * aside / radius;
    vec2 turned = radius * vec2(cos(angle), sin(angle));
    return is_wide ? turned : turned.yx;
}
// ANCHOR_END: disk

// ANCHOR: blades
// A corner of the unit polygon. The angle is from -pi to pi: beyond, Vulkan says nothing of a sine's error.
// So the whole turn is rounded down: half of the float that is nearest to it lies beyond pi.
vec2 corner(float turn) {
    float angle = 6.283185 * (fract(turn + 0.5) - 0.5);
    return vec2(cos(angle), sin(angle));
}

// A regular polygon is as many triangles as it has corners, and they are equally large. Within one, what is
// nearer to the middle than r is the part r^2: hence the root.
vec2 polygon_point(uint corners, float turn, vec2 u) {
    float sector = u.x * corners;
    float first = floor(sector);
    vec2 from = corner(turn + first / corners);
    vec2 to = corner(turn + (first + 1.0) / corners);
    return sqrt(u.y) * mix(from, to, sector - first);
}
// ANCHOR_END: blades

// ANCHOR: ray
// The ray through a place in the picture, in pixels, from a place on the lens.
void through_lens(CameraBasis camera, Lens lens, vec2 point, uvec2 size, vec2 u, out vec3 origin,
        out vec3 direction) {
    vec2 screen = 2.0 * point / vec2(size) - 1.0;
    // To the point in focus, with the distance of its plane as the unit.
    vec3 to_focus = camera.forward + screen.x * camera.right - screen.y * camera.up;
    vec2 unit = lens.blades < 3 ? disk_point(u) : polygon_point(lens.blades, lens.turn, u);
    vec2 place = lens.radius * unit;
    vec3 offset = place.x * normalize(camera.right) + place.y * normalize(camera.up);
    precise vec3 from = camera.origin + offset;
    // The origin is rounded: this is what it has of the offset.
    precise vec3 moved = from - camera.origin;
    origin = from;
    direction = normalize(to_focus - lens.inverse_focus * moved);
}
// ANCHOR_END: ray
