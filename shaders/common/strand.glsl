// Taught by 18_swept_spheres.
//
// Strands: chains of swept spheres.

struct Node {
    vec3 center;
    float radius;
};

// From the node `first` to the one after it. The next segment of a chain begins where this one ends.
struct Segment {
    uint first;
    uint material;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Nodes { Node at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Segments { Segment at[]; };

// The hit attributes, from the intersection shader to the closest hit shader.
struct Crossing {
    vec3 outward;   // unit normal
    float s;        // of which ball of the swept sphere: 0 at its first end, 1 at its last
};

// A tip, a ball of radius 0, has no normal: a ray that meets the very point is taken to meet it straight on.
Crossing crossing_of(vec3 outward, float s, vec3 d) {
    return Crossing(dot(outward, outward) > 0.0 ? outward : -normalize(d), s);
}

// The hit computed anew, from the shape and not from the ray: on the ball that touches the surface there, at its
// end along the normal. `own` is by how much it may be wrong, in roundings.
//
// As for a sphere in 08, a bound of 46u·r, and two roundings more: centre and radius are sums of the ends'.
// Where a ray starts beside such a ball by an angle e, it lies r·e²/2 below the surface: the normal is off by less
// than 64u, which adds nothing.
vec3 strand_point(Node a, Node b, Crossing crossing, out vec3 own, out float radius) {
    precise vec3 center = crossing.s == 1.0 ? b.center : a.center + crossing.s * (b.center - a.center);
    precise float of_ball = crossing.s == 1.0 ? b.radius : a.radius + crossing.s * (b.radius - a.radius);
    precise vec3 point = center + of_ball * crossing.outward;
    vec3 ends = max(abs(a.center), abs(b.center));
    own = abs(point) + 4.0 * ends + vec3(50.0 * max(a.radius, b.radius));
    radius = of_ball;
    return point;
}
