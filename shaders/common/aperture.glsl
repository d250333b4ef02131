// Taught by 28_depth_of_field.
//
// Places in an aperture: a disk or a regular polygon, of radius 1.

// A square becomes a disk, ring by ring: what is uniform stays uniform, and neighbours stay neighbours
// (Shirley and Chiu 1997).
vec2 concentric_point(vec2 u) {
    vec2 place = 2.0 * u - 1.0;
    bool is_wide = abs(place.x) > abs(place.y);
    float radius = is_wide ? place.x : place.y;
    float aside = is_wide ? place.y : place.x;
    // The four sides of a square ring are a quarter of a circle each.
    float angle = radius == 0.0 ? 0.0 : 0.7853981 * aside / radius;
    vec2 turned = radius * vec2(cos(angle), sin(angle));
    return is_wide ? turned : turned.yx;
}

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
