// A ray against a quadric in two-floats: where quadric.glsl ends. After two_float.glsl's sums and products, which say what
// they need.
#include "common/two_float.glsl"

const uint QUADRIC_TWO_FLOAT = 2;


// A component of the gradient: 2·square·p + mixed·p' + other·p'' + linear.
vec2 slope_along(float square, vec2 p, float mixed, vec2 next, float other, vec2 last, float linear) {
    vec3 sum = vec3(linear, 0.0, 0.0);
    sum_add_product(sum, p, 2.0 * square);
    sum_add_product(sum, next, mixed);
    sum_add_product(sum, last, other);
    return sum_total(sum);
}

TwoFloat3 gradient_two_float(Quadric q, TwoFloat3 p, vec3 linear) {
    return TwoFloat3(
        slope_along(q.square.x, p.x, q.mixed.z, p.y, q.mixed.y, p.z, linear.x),
        slope_along(q.square.y, p.y, q.mixed.x, p.z, q.mixed.z, p.x, linear.y),
        slope_along(q.square.z, p.z, q.mixed.y, p.x, q.mixed.x, p.y, linear.z));
}

vec2 moved_along(vec2 start, vec2 t, float d) {
    vec3 sum = vec3(start, 0.0);
    sum_add_product(sum, t, d);
    return sum_total(sum);
}

// ANCHOR: quadric
// The origin moves along the ray by a float with few digits, to a point near the origin of the coordinates. So its
// products with d are exact, and so is the point: where coefficients and ray are whole numbers, a tangent's discriminant
// is exactly 0.
bool quadric_two_float(Quadric q, vec3 o, vec3 d, float tmin, float tmax, out Roots roots, out vec3 normal) {
    roots = Roots(0, vec2(0.0));
    normal = vec3(0.0);
    int speed = exponent_of(d);
    d = scaled(d, -speed);
    float largest = max(abs(q.rest), max(max(abs(q.linear.x), abs(q.linear.y)), abs(q.linear.z)));
    int size = max(exponent_of(largest), max(exponent_of(q.square), exponent_of(q.mixed)));
    q = Quadric(scaled(q.square, -size), scaled(q.mixed, -size), scaled(q.linear, -size), scaled(q.rest, -size));

    precise float foot = -dot(o, d) / dot(d, d);
    precise vec3 there = o + foot * d;
    int grid = clamp(exponent_of(there), -10, 40);
    precise float steps = floor(scaled(foot, -grid) + 0.5);
    vec2 start = vec2(scaled(steps, grid), 0.0);
    TwoFloat3 p = TwoFloat3(moved_along(vec2(o.x, 0.0), start, d.x), moved_along(vec2(o.y, 0.0), start, d.y),
        moved_along(vec2(o.z, 0.0), start, d.z));

    TwoFloat3 along = ff_vector(d);
    // 2a, b and 2c: the polynomial is quadratic, so the gradient has all of it.
    vec2 twice_a = ff_dot(gradient_two_float(q, along, vec3(0.0)), d);
    TwoFloat3 gradient = gradient_two_float(q, p, q.linear);
    vec2 b = ff_dot(gradient, d);
    vec3 sum = vec3(2.0 * q.rest, 0.0, 0.0);
    sum_add_product(sum, gradient.x, p.x);
    sum_add_product(sum, gradient.y, p.y);
    sum_add_product(sum, gradient.z, p.z);
    sum_add_product(sum, p.x, q.linear.x);
    sum_add_product(sum, p.y, q.linear.y);
    sum_add_product(sum, p.z, q.linear.z);
    vec2 twice_c = sum_total(sum);
    sum = vec3(0.0);
    sum_add_product(sum, b, b);
    sum_add_product(sum, twice_a, -twice_c);
    vec2 discriminant = sum_total(sum);
    if (discriminant.x < 0.0 || (twice_a.x == 0.0 && b.x == 0.0)) {
        return false;
    }
    vec2 root = ff_sqrt(discriminant);
    vec2 s = b.x > 0.0 ? -ff_add(b, root) : ff_sub(root, b);
    vec2 small = s.x != 0.0 ? ff_div(twice_c, s) : vec2(0.0);
    vec2 large = twice_a.x != 0.0 ? ff_div(s, twice_a) : small;
    bool is_one = twice_a.x == 0.0 || discriminant.x == 0.0;
    if (discriminant.x == 0.0) {
        small = large;
    }
    bool swaps = ff_less(large, small);
    vec2 x[2] = vec2[2](swaps ? large : small, swaps ? small : large);
    int met = 0;
    for (int i = is_one ? 0 : 1; i >= 0; i--) {
        vec2 t = scaled(ff_add(start, x[i]), -speed);
        if (ff_within(t, tmin, tmax)) {
            roots.count++;
            roots.at.x = t.x;
            met = i;
        }
    }
    if (roots.count == 0) {
        return false;
    }
    TwoFloat3 hit = TwoFloat3(ff_add(p.x, ff_mul(x[met], d.x)), ff_add(p.y, ff_mul(x[met], d.y)),
        ff_add(p.z, ff_mul(x[met], d.z)));
    normal = ff_normalize(gradient_two_float(q, hit, q.linear));
    return true;
}
// ANCHOR_END: quadric
