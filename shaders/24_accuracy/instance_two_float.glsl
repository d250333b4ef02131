// A ray against the unit sphere under a matrix, in two-floats: where common/instance.glsl ends.
#include "sphere_two_float.glsl"

const uint INSTANCE_TWO_FLOAT = 2;

// A matrix of two-floats by its rows.
struct TwoFloatRows {
    TwoFloat3 x;
    TwoFloat3 y;
    TwoFloat3 z;
};

// The first hit with tmin < t <= tmax; L and T as they are, and L^-1 in two floats an entry.
//
// The ray meets the sphere or not by the length of the cross product of origin and direction in the
// object's space. For any two vectors (L^-1 f) × (L^-1 d) is L^T (f × d) / det L: so the cancelling is
// done in the world, where o, d and T are exact.
bool instance_two_float(vec3 o, vec3 d, float tmin, float tmax, mat3 linear, vec3 translation,
    TwoFloatRows inverse, out float t, out vec3 normal) {
    t = 0.0;
    normal = vec3(0.0);
    // The direction gets length 1 there, by a power of two.
    int speed = exponent_of(d);
    vec3 direction = scaled(d, -speed);
    vec3 there = vec3(
        ff_dot(inverse.x, direction).x, ff_dot(inverse.y, direction).x, ff_dot(inverse.z, direction).x);
    int more = exponent_of(there);
    direction = scaled(direction, -more);
    TwoFloat3 to = TwoFloat3(
        ff_dot(inverse.x, direction), ff_dot(inverse.y, direction), ff_dot(inverse.z, direction));

    TwoFloat3 f = ff_difference(o, translation);
    TwoFloat3 from = TwoFloat3(ff_dot(inverse.x, f), ff_dot(inverse.y, f), ff_dot(inverse.z, f));
    TwoFloat3 moment = ff_cross(f, direction);
    vec2 shrinking = ff_dot(inverse.x, ff_cross(inverse.y, inverse.z));   // 1 / det L
    TwoFloat3 across = TwoFloat3(
        ff_dot(moment, linear[0]), ff_dot(moment, linear[1]), ff_dot(moment, linear[2]));
    across = ff_mul(across, shrinking);

    vec3 c = vec3(-1.0, 0.0, 0.0);
    sum_add_product(c, from.x, from.x);
    sum_add_product(c, from.y, from.y);
    sum_add_product(c, from.z, from.z);
    SphereRoots roots =
        sphere_roots(ff_dot(to, to), -ff_dot(from, to), sum_total(c), across, vec2(1.0, 0.0));
    if (!roots.met) {
        return false;
    }
    vec2 near = scaled(roots.near, -speed - more);
    vec2 far = scaled(roots.far, -speed - more);
    bool enters = ff_within(near, tmin, tmax);
    if (!enters && !ff_within(far, tmin, tmax)) {
        return false;
    }
    t = enters ? near.x : far.x;
    TwoFloat3 n = sphere_outward(roots, to, enters);
    normal = ff_normalize(TwoFloat3(
        ff_dot(n, TwoFloat3(inverse.x.x, inverse.y.x, inverse.z.x)),
        ff_dot(n, TwoFloat3(inverse.x.y, inverse.y.y, inverse.z.y)),
        ff_dot(n, TwoFloat3(inverse.x.z, inverse.y.z, inverse.z.z))));
    return true;
}
