// Taught by 24_accuracy.
//
// A ray against a triangle in software, in three ways that are equal on paper.
//
// a, b, c are the corners, o the ray's origin, d its direction of any length. Both sides count, and the
// edges belong to the triangle. A mesh must let no ray through between two triangles that share an
// edge. So both triangles must compute the same number for the edge, one with the opposite sign.
#include "common/two_float.glsl"

const uint TRIANGLE_MOELLER = 0;
const uint TRIANGLE_WOOP = 1;
const uint TRIANGLE_TWO_FLOAT = 2;

// Cramer's rule for the hit's weights (Moeller and Trumbore, JGT 2:1, 1997). The weight at an edge is
// reckoned from the other two edges, which the neighbour does not have: rays slip through between them.
bool triangle_moeller(vec3 a, vec3 b, vec3 c, vec3 o, vec3 d, out float t) {
    precise vec3 e1 = b - a;
    precise vec3 e2 = c - a;
    precise vec3 p = cross(d, e2);
    precise float determinant = dot(e1, p);
    t = 0.0;
    if (determinant == 0.0) {
        return false;
    }
    precise vec3 from_a = o - a;
    precise vec3 q = cross(from_a, e1);
    precise float u = dot(from_a, p) / determinant;
    precise float v = dot(d, q) / determinant;
    precise float distance = dot(e2, q) / determinant;
    precise float both = u + v;
    t = distance;
    return u >= 0.0 && v >= 0.0 && both <= 1.0;
}

// The axis along which the ray goes farthest becomes z: what will be divided by is never small.
uint longest_axis(vec3 d) {
    vec3 size = abs(d);
    return size.x >= max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
}

vec3 permuted(vec3 v, uint axis) {
    return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v;
}

TwoFloat3 permuted(TwoFloat3 v, uint axis) {
    if (axis == 0) {
        return TwoFloat3(v.y, v.z, v.x);
    }
    if (axis == 1) {
        return TwoFloat3(v.z, v.x, v.y);
    }
    return v;
}

// True if the ray passes no two edges on different sides.
bool same_side(float u, float v, float w) {
    return !((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0));
}

// On which side of an edge the ray passes: twice the area that it spans with the edge, seen along the
// ray. Where the products are equal when rounded, what rounding left decides.
float edge_side(vec2 from, vec2 to) {
    precise float area = from.x * to.y - from.y * to.x;
    if (area == 0.0) {
        vec2 plus = two_product(from.x, to.y);
        vec2 minus = two_product(from.y, to.x);
        precise float rest = (plus.x - minus.x) + (plus.y - minus.y);
        area = rest;
    }
    return area;
}

// The corners slide along the ray into the plane z = 0. Two triangles that share a corner see it at the
// same place, rounding and all, and the shared edge likewise (Woop, Benthin and Wald, JCGT 2:1, 2013).
bool triangle_woop(vec3 a, vec3 b, vec3 c, vec3 o, vec3 d, out float t) {
    t = 0.0;
    if (d == vec3(0.0)) {
        return false;
    }
    uint axis = longest_axis(d);
    d = permuted(d, axis);
    precise vec3 p = permuted(a - o, axis);
    precise vec3 q = permuted(b - o, axis);
    precise vec3 r = permuted(c - o, axis);
    precise vec2 slope = d.xy / d.z;
    precise vec2 p_flat = p.xy - slope * p.z;
    precise vec2 q_flat = q.xy - slope * q.z;
    precise vec2 r_flat = r.xy - slope * r.z;
    float u = edge_side(r_flat, q_flat);
    float v = edge_side(p_flat, r_flat);
    float w = edge_side(q_flat, p_flat);
    precise float determinant = u + v + w;
    if (!same_side(u, v, w) || determinant == 0.0) {
        return false;
    }
    precise float depth = (u * p.z + v * q.z + w * r.z) / determinant;
    precise float distance = depth / d.z;
    t = distance;
    return true;
}

// The same, with more bits than the corners have: what is not exact is the place of a corner, by one
// part in 2^48. Then t is from the plane of the triangle; the normal is on the ray's side.
bool triangle_two_float(
    vec3 a, vec3 b, vec3 c, vec3 o, vec3 d, float tmin, float tmax, out float t, out vec3 normal) {
    t = 0.0;
    normal = vec3(0.0);
    TwoFloat3 p = ff_difference(a, o);
    TwoFloat3 q = ff_difference(b, o);
    TwoFloat3 r = ff_difference(c, o);
    vec3 reach = max(max(abs(rounded(p)), abs(rounded(q))), abs(rounded(r)));
    int size = exponent_of(reach);
    int speed = exponent_of(d);
    vec3 direction = scaled(d, -speed);
    p = scaled(p, -size);
    q = scaled(q, -size);
    r = scaled(r, -size);

    // Sliding without a division: the first two components of the cross product with the direction say
    // where a corner lies, as the ray sees it. Each is a sum that may cancel.
    uint axis = longest_axis(direction);
    vec3 along = permuted(direction, axis);
    TwoFloat3 p_flat = ff_cross(permuted(p, axis), along);
    TwoFloat3 q_flat = ff_cross(permuted(q, axis), along);
    TwoFloat3 r_flat = ff_cross(permuted(r, axis), along);
    float u = ff_determinant(r_flat.x, r_flat.y, q_flat.x, q_flat.y).x;
    float v = ff_determinant(p_flat.x, p_flat.y, r_flat.x, r_flat.y).x;
    float w = ff_determinant(q_flat.x, q_flat.y, p_flat.x, p_flat.y).x;
    if (!same_side(u, v, w)) {
        return false;
    }

    // Only the normal's direction matters: each edge may have a scale of its own.
    TwoFloat3 e1 = ff_difference(b, a);
    TwoFloat3 e2 = ff_difference(c, a);
    TwoFloat3 n = ff_cross(
        scaled(e1, -exponent_of(rounded(e1))), scaled(e2, -exponent_of(rounded(e2))));
    n = scaled(n, -exponent_of(rounded(n)));
    vec2 slope = ff_dot(n, direction);
    // Zero, but for the rounding of n: the ray lies in the triangle's plane, or that has no area.
    if (abs(slope.x) <= 1e-13 * dot(abs(rounded(n)), abs(direction))) {
        return false;
    }
    vec2 exact = scaled(ff_div(ff_dot(n, p), slope), size - speed);
    if (!ff_within(exact, tmin, tmax)) {
        return false;
    }
    t = exact.x;
    normal = ff_normalize(n);
    normal = slope.x > 0.0 ? -normal : normal;
    return true;
}
