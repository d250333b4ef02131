// Taught by 33_roots.
//
// Tori, and the point of one that was hit.

struct Torus {
    vec3 center;
    vec3 axis;       // any length but 0
    float major;     // R, from the centre to the middle of the tube
    float minor;     // r, of the tube: at most R
    uint material;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Tori { Torus at[]; };

// The hit attributes: the ring's and the surface's direction at the hit.
struct TorusFrame {
    vec3 ring;
    vec3 outward;
};

// A tenth of a length, in roundings of it.
const float TENTH = 1677721.6;

// The hit, computed from the shape and not along the ray, so that the distance to the ray's origin adds no error.
// `own` is the height above the surface at which the next ray may start, in roundings, without those of the point's
// and the centre's coordinates.
//
// The point is centre + R·ring + r·outward. Unit vectors are off by 16u, and by as much again from the axis; products
// and sums round: 40u·(R + r) + 3u·|p|. The next ray's polynomial is at most about 4(R + r)⁴ and off by 16u of that;
// its gradient at the surface is 8·R·r·ρ, where ρ is the distance from the axis, so that moves the surface by
// 8u·(R + r)⁴ / (R·r·ρ). The inner side of a thin hole has a small ρ: no step is larger than a tenth of the tube.
vec3 torus_point(Torus torus, TorusFrame frame, out float own) {
    float size = torus.major + torus.minor;
    precise vec3 tube = torus.major * frame.ring;
    precise vec3 local = tube + torus.minor * frame.outward;
    precise vec3 point = torus.center + local;
    float from_axis = max(torus.major + torus.minor * dot(frame.ring, frame.outward), 1e-3 * torus.major);
    float test = 8.0 * (size / torus.major) * (size / torus.minor) * (size / from_axis) * size;
    own = 40.0 * size + min(test, TENTH * torus.minor);
    return point;
}
