// The opening of a lens: a disk, or the polygon that its blades leave.

// A point of the opening, which reaches 1 from its middle: each as likely as any other. u is from 0 to 1.
vec2 lens_point(vec2 u, uint blades) {
    // From -pi to pi, for beyond Vulkan says nothing of a sine's error; and a quotient may be off by 2.5 ULP.
    const float TURN = 6.28318;
    if (blades < 3) {
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
