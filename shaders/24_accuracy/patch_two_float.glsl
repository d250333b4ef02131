// A ray against a bilinear patch in two-floats: patch_stable() without its roundings, and with what remains where all areas of
// one kind are 0. After patch.glsl, and two_float.glsl's sums and products, which say what they need.
#include "common/two_float.glsl"

const uint PATCH_TWO_FLOAT = 2;

// A fraction of two-floats, over / under, as patch_root() returns.
struct Fraction {
    vec2 over;
    vec2 under;
};

Fraction patch_root(vec2 first, vec2 middle, vec2 last, vec2 root, float side) {
    if (root.x == 0.0 && middle.x == 0.0) {
        return last.x != 0.0 ? Fraction(vec2(0.0), last) : Fraction(first, vec2(0.0));
    }
    bool is_sum = (middle.x >= 0.0) == (side < 0.0);
    vec2 sum = ff_sub(middle.x >= 0.0 ? -root : root, middle);
    return is_sum ? Fraction(sum, 2.0 * last) : Fraction(2.0 * first, sum);
}

bool patch_is_within(Fraction x) {
    return patch_is_within(vec2(x.over.x, x.under.x));
}

// Both parts of a fraction from 0 to infinity, so that they add up to about 1, without a sign.
Fraction patch_shares(Fraction x) {
    int size = exponent_of(max(abs(x.over.x), abs(x.under.x)));
    float side = x.over.x < 0.0 || x.under.x < 0.0 ? -1.0 : 1.0;
    return Fraction(side * scaled(x.over, -size), side * scaled(x.under, -size));
}

vec2 patch_mix(Fraction share, vec2 at_0, vec2 at_1) {
    return ff_add(ff_mul(share.under, at_0), ff_mul(share.over, at_1));
}

TwoFloat3 patch_mix(Fraction share, TwoFloat3 at_0, TwoFloat3 at_1) {
    return TwoFloat3(
        patch_mix(share, at_0.x, at_1.x), patch_mix(share, at_0.y, at_1.y), patch_mix(share, at_0.z, at_1.z));
}

vec2 patch_discriminant(vec2 first, vec2 middle, vec2 last) {
    vec3 sum = vec3(0.0);
    sum_add_product(sum, middle, middle);
    sum_add_product(sum, -4.0 * first, last);
    return sum_total(sum);
}

// A point of the ray, o + start·d.
vec2 patch_at(float o, float start, float d) {
    vec3 sum = vec3(o, 0.0, 0.0);
    sum_add_product(sum, start, d);
    return sum_total(sum);
}

vec2 patch_from(float corner, vec2 there) {
    vec3 sum = vec3(corner, 0.0, 0.0);
    sum_add(sum, -there);
    return sum_total(sum);
}

// True if a line of the surface on the ray has no length: both ends are as far along the ray.
bool patch_is_point(vec2 end, vec2 other, float size) {
    return abs(ff_sub(end, other).x) <= 9.1e-13 * size;    // 2^-40
}

// Products that need not cancel to the last digit.
TwoFloat3 patch_cross(TwoFloat3 a, TwoFloat3 b) {
    return TwoFloat3(ff_sub(ff_mul(a.y, b.z), ff_mul(a.z, b.y)), ff_sub(ff_mul(a.z, b.x), ff_mul(a.x, b.z)),
        ff_sub(ff_mul(a.x, b.y), ff_mul(a.y, b.x)));
}

vec2 patch_dot(TwoFloat3 a, TwoFloat3 b) {
    return ff_add(ff_add(ff_mul(a.x, b.x), ff_mul(a.y, b.y)), ff_mul(a.z, b.z));
}

// ANCHOR: patch
void patch_two_float(Patch q, vec3 o, vec3 d, float tmin, float tmax, out PatchHits hits, out vec3 normal) {
    hits = PatchHits(0, 0.0, vec2(0.0));
    normal = vec3(0.0);
    // No edge is longer than about 1, nor is the direction.
    int speed = exponent_of(d);
    d = scaled(d, -speed);
    int size = exponent_of(max(max(abs(q.q10 - q.q00), abs(q.q01 - q.q00)), abs(q.q11 - q.q00)));
    q = Patch(scaled(q.q00, -size), scaled(q.q10, -size), scaled(q.q01, -size), scaled(q.q11, -size));
    o = scaled(o, -size);
    // A whole number, so that no product with d rounds.
    precise vec3 middle = 0.25 * q.q00 + 0.25 * q.q10 + 0.25 * q.q01 + 0.25 * q.q11 - o;
    precise float foot = dot(middle, d) / dot(d, d);
    precise float start = floor(foot + 0.5);

    int axis = patch_axis(d);
    vec3 ahead = patch_turned(d, axis);
    o = patch_turned(o, axis);
    TwoFloat3 there =
        TwoFloat3(patch_at(o.x, start, ahead.x), patch_at(o.y, start, ahead.y), patch_at(o.z, start, ahead.z));
    vec3 corners[4] = vec3[4](q.q00, q.q10, q.q01, q.q11);
    vec2 x[4];
    vec2 y[4];
    vec2 height[4];
    float highest = 0.0;
    for (int n = 0; n < 4; n++) {
        vec3 corner = patch_turned(corners[n], axis);
        TwoFloat3 p =
            TwoFloat3(patch_from(corner.x, there.x), patch_from(corner.y, there.y), patch_from(corner.z, there.z));
        x[n] = ff_determinant(p.x, p.z, ahead.x, ahead.z);
        y[n] = ff_determinant(p.y, p.z, ahead.y, ahead.z);
        height[n] = patch_dot(p, ff_vector(ahead));
        highest = max(highest, abs(height[n].x));
    }
    // Areas u0, u2, v0, v2 and both diagonals', as in patch_stable().
    ivec2 pairs[6] = ivec2[6](ivec2(0, 2), ivec2(1, 3), ivec2(0, 1), ivec2(2, 3), ivec2(0, 3), ivec2(1, 2));
    vec2 area[6];
    float most = 0.0;
    for (int n = 0; n < 6; n++) {
        ivec2 pair = pairs[n];
        area[n] = ff_determinant(x[pair.x], y[pair.x], x[pair.y], y[pair.y]);
        most = max(most, abs(area[n].x));
    }
    if (most == 0.0) {
        return;
    }
    for (int n = 0; n < 6; n++) {
        area[n] = scaled(area[n], -exponent_of(most));
    }
    vec2 u1 = ff_add(area[4], area[5]);
    vec2 v1 = ff_sub(area[4], area[5]);
    bool has_u = area[0].x != 0.0 || u1.x != 0.0 || area[1].x != 0.0;
    bool has_v = area[2].x != 0.0 || v1.x != 0.0 || area[3].x != 0.0;
    bool is_of_u =
        max(u1.x * u1.x, abs(area[0].x * area[1].x)) < max(v1.x * v1.x, abs(area[2].x * area[3].x));
    vec2 discriminant =
        patch_discriminant(is_of_u ? area[0] : area[2], is_of_u ? u1 : v1, is_of_u ? area[1] : area[3]);
    if (discriminant.x < 0.0) {
        return;
    }
    vec2 root = ff_sqrt(discriminant);
    vec2 along = patch_dot(ff_vector(d), ff_vector(d));
    Fraction first_u;
    Fraction first_v;
    vec2 first = vec2(0.0);
    for (float side = -1.0; side <= (root.x > 0.0 ? 1.0 : -1.0); side += 2.0) {
        Fraction u = patch_root(area[0], u1, area[1], root, side);
        // Of (1 - v) / v.
        Fraction v = patch_root(area[3], v1, area[2], root, side);
        v = Fraction(v.under, v.over);
        // Every line of one kind meets the ray: it lies in one of the other kind, or goes through one that is a point, as
        // an edge may be, or the middle of a bow.
        if (!has_u && patch_is_within(v)) {
            Fraction at = patch_shares(v);
            if (patch_is_point(patch_mix(at, height[0], height[2]), patch_mix(at, height[1], height[3]), highest)) {
                u = Fraction(vec2(1.0, 0.0), vec2(1.0, 0.0));
            }
        }
        if (!has_v && patch_is_within(u)) {
            Fraction at = patch_shares(u);
            if (patch_is_point(patch_mix(at, height[0], height[1]), patch_mix(at, height[2], height[3]), highest)) {
                v = Fraction(vec2(1.0, 0.0), vec2(1.0, 0.0));
            }
        }
        if (!patch_is_within(u) || !patch_is_within(v)) {
            continue;
        }
        u = patch_shares(u);
        v = patch_shares(v);
        vec2 over = patch_mix(u, patch_mix(v, height[0], height[2]), patch_mix(v, height[1], height[3]));
        vec2 under = ff_mul(ff_mul(ff_add(u.over, u.under), ff_add(v.over, v.under)), along);
        vec2 t = ff_add(vec2(start, 0.0), ff_div(over, under));
        // A hit nearer to tmin than two-floats can tell is at tmin, as where the ray leaves the patch itself.
        bool is_past = ff_sub(t, vec2(scaled(tmin, speed - size), 0.0)).x > 2.3e-13;
        t = scaled(t, size - speed);
        if (is_past && ff_within(t, tmin, tmax)) {
            if (hits.count == 0 || ff_less(t, first)) {
                first = t;
                first_u = u;
                first_v = v;
            }
            hits.count++;
        }
    }
    if (hits.count == 0) {
        return;
    }
    hits.t = first.x;
    TwoFloat3 low_u = ff_difference(q.q10, q.q00);
    TwoFloat3 low_v = ff_difference(q.q01, q.q00);
    if (hits.count == 2) {
        // A flat patch that is folded has two pairs of u and v at one point.
        vec2 volume = patch_dot(patch_cross(low_u, low_v), ff_difference(q.q11, q.q00));
        hits.count = volume.x == 0.0 ? 1 : 2;
    }
    TwoFloat3 along_u = patch_mix(first_v, low_u, ff_difference(q.q11, q.q01));
    TwoFloat3 along_v = patch_mix(first_u, low_v, ff_difference(q.q11, q.q10));
    normal = ff_normalize(patch_cross(along_u, along_v));
}
// ANCHOR_END: patch
