// A ray against a capsule in two-floats: where capsule.glsl ends.
//
// o is the ray's origin, the segment goes from a to b. A root on the body is kept as the ray's parameter
// and as the outward vector there, like a root on a sphere.
#include "sphere_two_float.glsl"

const uint CAPSULE_TWO_FLOAT = 2;

// Where a line meets the infinite cylinder around the segment.
struct BodyRoots {
    bool met;
    bool parallel;
    vec2 near;
    vec2 far;
    vec2 near_height;   // along the segment, from 0 to |u|²
    vec2 far_height;
    vec2 beside;        // the distance between line and axis, times |d × u|
    vec2 half_chord;    // sqrt(r²·|d × u|² - beside²) / |u|
    TwoFloat3 across;   // d × u
};

// start + t·d - s·u, all products and the sum exact before they are rounded.
vec2 moved(vec2 start, float t, float d, float s, vec2 u) {
    vec3 sum = vec3(start, 0.0);
    sum_add_product(sum, t, d);
    sum_add_product(sum, u, -s);
    return sum_total(sum);
}

// Of t and s, floats near the point where line and segment are closest will do: from there the line and
// the axis are begun anew, w apart. Then no term is larger than the capsule is thick, whatever its length
// and its distance.
BodyRoots body_roots(TwoFloat3 f, vec3 d, TwoFloat3 u, float r) {
    TwoFloat3 across = ff_cross(u, -d);
    vec2 a = ff_dot(across, across);
    vec2 uu = ff_dot(u, u);
    BodyRoots roots = BodyRoots(
        true, true, vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0), across);
    if (!(a.x > 0.0)) {
        return roots;
    }
    roots.parallel = false;

    float ud = ff_dot(u, d).x;
    float fd = ff_dot(f, d).x;
    float fu = ff_dot(f, u).x;
    float s = clamp((dot(d, d) * fu - fd * ud) / a.x, 0.0, 1.0);
    float t = (s * ud - fd) / dot(d, d);
    TwoFloat3 w = TwoFloat3(
        moved(f.x, t, d.x, s, u.x), moved(f.y, t, d.y, s, u.y), moved(f.z, t, d.z, s, u.z));

    roots.beside = ff_dot(w, across);
    vec2 square = ff_sub(ff_mul(a, two_product(r, r)), ff_mul(roots.beside, roots.beside));
    roots.met = square.x >= 0.0;
    if (!roots.met) {
        return roots;
    }
    vec2 length_u = ff_sqrt(uu);
    vec2 root = ff_sqrt(square);
    roots.half_chord = ff_div(root, length_u);
    vec2 middle = ff_dot(ff_cross(u, w), across);
    vec2 half_way = ff_mul(root, length_u);
    vec2 near = ff_div(ff_sub(middle, half_way), a);
    vec2 far = ff_div(ff_add(middle, half_way), a);
    vec2 height = ff_add(ff_mul(uu, s), ff_dot(w, u));
    roots.near_height = ff_add(height, ff_mul(ff_dot(u, d), near));
    roots.far_height = ff_add(height, ff_mul(ff_dot(u, d), far));
    roots.near = ff_add(near, vec2(t, 0.0));
    roots.far = ff_add(far, vec2(t, 0.0));
    return roots;
}

// The normal on the body, times r·|d × u|²: one part along the common perpendicular, the other across
// it and the axis, against the ray where it enters.
TwoFloat3 body_outward(BodyRoots roots, TwoFloat3 u, bool enters) {
    vec2 chord = enters ? -roots.half_chord : roots.half_chord;
    TwoFloat3 sideways = ff_mul(ff_cross(roots.across, u), chord);
    return ff_sub(ff_mul(roots.across, roots.beside), sideways);
}

// The first hit with tmin < t <= tmax.
bool capsule_two_float(vec3 o, vec3 d, float tmin, float tmax, vec3 a, vec3 b, float r, out float t,
    out vec3 normal) {
    t = 0.0;
    normal = vec3(0.0);
    TwoFloat3 f = ff_difference(o, a);
    TwoFloat3 u = ff_difference(b, a);
    int size = max(exponent_of(r), exponent_of(rounded(u)));
    size = max(size, exponent_of(rounded(f)) - 40);
    int speed = exponent_of(d);
    vec3 direction = scaled(d, -speed);
    float radius = scaled(r, -size);
    f = scaled(f, -size);
    u = scaled(u, -size);
    TwoFloat3 from_end = scaled(ff_difference(o, b), -size);

    BodyRoots body = body_roots(f, direction, u, radius);
    if (!body.met) {
        return false;
    }
    vec2 uu = ff_dot(u, u);
    for (int k = 0; k < 2; k++) {
        bool enters = k == 0;
        vec2 height = enters ? body.near_height : body.far_height;
        bool below = !(height.x > 0.0);
        bool above = !ff_less(height, uu);
        if (body.parallel) {
            // Along the axis, the ray comes in at one end and leaves at the other.
            below = enters == (ff_dot(u, direction).x > 0.0);
            above = !below;
        }
        vec2 root = enters ? body.near : body.far;
        TwoFloat3 outward;
        if (below || above) {
            SphereRoots end = sphere_roots(below ? f : from_end, direction, radius);
            if (!end.met) {
                return false;
            }
            root = enters ? end.near : end.far;
            outward = sphere_outward(end, ff_vector(direction), enters);
        } else {
            outward = body_outward(body, u, enters);
        }
        root = scaled(root, size - speed);
        if (ff_within(root, tmin, tmax)) {
            t = root.x;
            normal = ff_normalize(outward);
            return true;
        }
    }
    return false;
}
