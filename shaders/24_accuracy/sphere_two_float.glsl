// A ray against a sphere, where common/sphere.glsl ends: with more than 24 bits, where they matter, and
// everywhere. After two_float.glsl's sums and products, which say what they need.
#include "common/two_float.glsl"

const uint SPHERE_COMPENSATED = 5;
const uint SPHERE_TWO_FLOAT = 6;

// sphere_stable() with dot products as good as if they had twice the bits. What remains is the rounding
// of f, of the foot and of d's multiple: enough for a sphere in the distance, not for a planet's ground.
bool sphere_compensated(vec3 f, vec3 d, float r, out vec2 t) {
    float a = dot_compensated(vec2(0.0), d, d);
    float b = -dot_compensated(vec2(0.0), f, d);
    precise float middle = b / a;
    vec3 foot;
    for (int i = 0; i < 3; i++) {
        vec2 product = two_product(middle, d[i]);
        vec2 sum = two_sum(f[i], product.x);
        precise float coordinate = sum.x + (sum.y + product.y);
        foot[i] = coordinate;
    }
    vec2 square = two_product(r, r);
    precise float discriminant = a * dot_compensated(square, -foot, foot);
    t = vec2(0.0);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    float c = dot_compensated(-square, f, f);
    precise float q = b < 0.0 ? b - sqrt(discriminant) : b + sqrt(discriminant);
    if (q != 0.0) {
        precise vec2 both = vec2(c / q, q / a);
        t = b < 0.0 ? both.yx : both;
    }
    return true;
}

// ANCHOR: roots
// Where a line meets a sphere, in two-floats: the roots of a·t² - 2b·t + c = 0.
struct SphereRoots {
    bool met;
    vec2 near;
    vec2 far;
    vec2 a;             // |d|²
    vec2 root;          // of the discriminant
    TwoFloat3 across;   // f × d: as long as the line's distance from the centre, times |d|
};

// The discriminant b² - a·c equals a·r² - |f × d|². There, no term is larger than the sphere; and each
// component of the cross product is a sum that may cancel as far as it likes. So neither the distance
// of the origin nor the size of the sphere costs a bit.
SphereRoots sphere_roots(vec2 a, vec2 b, vec2 c, TwoFloat3 across, vec2 square) {
    SphereRoots roots = SphereRoots(false, vec2(0.0), vec2(0.0), a, vec2(0.0), across);
    vec2 discriminant = ff_sub(ff_mul(a, square), ff_dot(across, across));
    roots.met = a.x > 0.0 && discriminant.x >= 0.0;
    if (!roots.met) {
        return roots;
    }
    roots.root = ff_sqrt(discriminant);
    bool behind = b.x < 0.0;
    vec2 q = behind ? ff_sub(b, roots.root) : ff_add(b, roots.root);
    // q = 0 is a tangent that begins where it touches; both roots are 0.
    if (q.x != 0.0) {
        vec2 large = ff_div(q, a);
        vec2 small = ff_div(c, q);
        roots.near = behind ? large : small;
        roots.far = behind ? small : large;
    }
    return roots;
}

// The roots for a sphere of radius r around the origin, seen from f.
SphereRoots sphere_roots(TwoFloat3 f, vec3 d, float r) {
    vec3 c = vec3(0.0);
    sum_add_product(c, f.x, f.x);
    sum_add_product(c, f.y, f.y);
    sum_add_product(c, f.z, f.z);
    sum_add_product(c, r, -r);
    vec2 a = ff_dot(ff_vector(d), d);
    return sphere_roots(a, -ff_dot(f, d), sum_total(c), ff_cross(f, d), two_product(r, r));
}

// The normal where the line enters or leaves, times r·a: from the foot of the perpendicular, which is
// d × (f × d) / a, half a chord along the line. Again no term is larger than the sphere.
TwoFloat3 sphere_outward(SphereRoots roots, TwoFloat3 d, bool enters) {
    TwoFloat3 along = ff_mul(d, enters ? roots.root : -roots.root);
    return ff_sub(ff_cross(d, roots.across), along);
}
// ANCHOR_END: roots

// The first hit with tmin < t <= tmax, from the origin itself: o - center need not be a float.
bool sphere_two_float(
    vec3 o, vec3 d, float tmin, float tmax, vec3 center, float r, out float t, out vec3 normal) {
    t = 0.0;
    normal = vec3(0.0);
    // The sphere becomes as large as 1, unless it is so far away that squares would overflow; d, too.
    TwoFloat3 f = ff_difference(o, center);
    int size = max(exponent_of(r), exponent_of(rounded(f)) - 50);
    int speed = exponent_of(d);
    vec3 direction = scaled(d, -speed);
    SphereRoots roots = sphere_roots(scaled(f, -size), direction, scaled(r, -size));
    if (!roots.met) {
        return false;
    }
    vec2 near = scaled(roots.near, size - speed);
    vec2 far = scaled(roots.far, size - speed);
    bool enters = ff_within(near, tmin, tmax);
    if (!enters && !ff_within(far, tmin, tmax)) {
        return false;
    }
    t = enters ? near.x : far.x;
    normal = ff_normalize(sphere_outward(roots, ff_vector(direction), enters));
    return true;
}
