// A ray against a swept sphere in two-floats: swept_stable() step by step, with twice the bits.
//
// Numbers in two floats are those of chapter 24, and so is what they need: rounding to nearest, `precise`.
#include "common/two_float.glsl"
#include "common/swept.glsl"

struct ExactFoot {
    TwoFloat3 p;
    vec2 t;
};

// start + t·d: products and sum are exact before they are rounded to a two-float.
vec2 ff_moved(vec2 start, vec2 t, vec2 d) {
    vec3 sum = vec3(start, 0.0);
    sum_add_product(sum, t, d);
    return sum_total(sum);
}

TwoFloat3 ff_moved(TwoFloat3 start, vec2 t, TwoFloat3 d) {
    return TwoFloat3(ff_moved(start.x, t, d.x), ff_moved(start.y, t, d.y), ff_moved(start.z, t, d.z));
}

// Each step is a float; two of them leave of the way along d less than a two-float can tell.
ExactFoot ff_foot(TwoFloat3 f, TwoFloat3 d, vec2 dd) {
    precise float t = -ff_dot(f, d).x / dd.x;
    TwoFloat3 p = ff_moved(f, vec2(t, 0.0), d);
    precise float rest = -ff_dot(p, d).x / dd.x;
    return ExactFoot(ff_moved(p, vec2(rest, 0.0), d), two_sum(t, rest));
}

// A power of two changes no bit of a number but its exponent.
ExactFoot in_unit(ExactFoot foot, float unit) {
    TwoFloat3 p = foot.p;
    return ExactFoot(TwoFloat3(unit * p.x, unit * p.y, unit * p.z), unit * foot.t);
}

// r² - |p|²: 0 or more if the line meets the ball.
vec2 ff_inside(ExactFoot foot, vec2 r) {
    return ff_sub(ff_mul(r, r), ff_dot(foot.p, foot.p));
}

bool swept_two_float(vec3 o, vec3 d, vec3 a, vec3 b, float r, float q, float tmin, out Root first) {
    float speed = unit_of(largest(d));
    TwoFloat3 dir = ff_vector(speed * d);
    vec2 dd = ff_dot(dir, dir);
    ExactFoot at_a = ff_foot(ff_difference(o, a), dir, dd);
    ExactFoot at_b = ff_foot(ff_difference(o, b), dir, dd);
    vec2 inside_a = ff_inside(at_a, vec2(r, 0.0));
    vec2 inside_b = ff_inside(at_b, vec2(q, 0.0));
    vec2 half_a = ff_sqrt(ff_div(inside_a, dd));
    vec2 half_b = ff_sqrt(ff_div(inside_b, dd));

    float unit = unit_of(max(largest(b - a), max(r, q)));
    at_a = in_unit(at_a, unit);
    at_b = in_unit(at_b, unit);
    half_a *= unit;
    half_b *= unit;
    inside_a *= unit * unit;
    inside_b *= unit * unit;
    r *= unit;
    q *= unit;
    TwoFloat3 u = ff_difference(unit * b, unit * a);
    vec2 delta = two_sum(q, -r);
    vec2 uu = ff_dot(u, u);
    vec2 k = ff_sub(uu, ff_mul(delta, delta));
    vec2 n = ff_dot(dir, u);

    // The nearest ball is chosen in floats: any choice is right, and this one loses the fewest digits.
    TwoFloat3 cross_du = ff_cross(dir, u);
    vec2 bend = ff_sub(ff_dot(cross_du, cross_du), ff_mul(ff_mul(delta, delta), dd));
    vec2 start_a = ff_add(ff_dot(at_a.p, u), ff_mul(delta, r));
    vec2 start_b = ff_add(ff_dot(at_b.p, u), ff_mul(delta, q));
    bool by_b = k.x <= 0.0 ? q > r
        : bend.x > 0.0 ? start_a.x * dd.x / bend.x > 0.5
        : q < r;
    float off = 0.0;
    if (k.x > 0.0 && bend.x > 0.0) {
        off = by_b ? min(start_b.x * dd.x / bend.x, 0.0) : max(start_a.x * dd.x / bend.x, 0.0);
    }
    ExactFoot end = by_b ? at_b : at_a;
    ExactFoot mid = end;
    vec2 ball = ff_add(vec2(by_b ? q : r, 0.0), ff_mul(delta, off));
    if (off != 0.0) {
        mid = ff_foot(ff_moved(end.p, vec2(-off, 0.0), u), dir, dd);
        mid.t = ff_add(mid.t, end.t);
    }
    vec2 inside = ff_inside(mid, ball);
    vec2 m = ff_add(ff_dot(mid.p, u), ff_mul(delta, ball));
    vec2 mm = ff_mul(m, m);
    vec2 square = ff_mul(k, ff_add(ff_mul(dd, mm), ff_mul(bend, inside)));
    bool met = inside.x >= 0.0;
    if (k.x > 0.0) {
        // Of the body's roots only those between the ends count; that they are real decides where the ball does not.
        met = inside_a.x >= 0.0 || inside_b.x >= 0.0 || (off != 0.0 ? square.x >= 0.0 : met);
    }
    if (!met) {
        return false;
    }

    vec2 root = ff_sqrt(square);
    vec2 c = -ff_add(ff_mul(k, inside), mm);
    vec2 mn = ff_mul(m, n);
    for (float side = -1.0; side <= 1.0; side += 2.0) {
        vec2 beyond_a = ff_add(start_a, side * ff_mul(half_a, n));
        vec2 beyond_b = ff_add(start_b, side * ff_mul(half_b, n));
        bool is_a = k.x > 0.0 ? inside_a.x >= 0.0 && beyond_a.x <= 0.0 : !by_b;
        bool is_b = k.x > 0.0 ? inside_b.x >= 0.0 && beyond_b.x >= 0.0 : by_b;
        is_a = is_a && !(inside_a.x == 0.0 && bend.x < 0.0 && side * n.x > 0.0);
        is_b = is_b && !(inside_b.x == 0.0 && bend.x < 0.0 && side * n.x < 0.0);
        vec2 start = mid.t;
        vec2 way;
        if (is_a || is_b) {
            start = is_a ? at_a.t : at_b.t;
            way = side * (is_a ? half_a : half_b);
            TwoFloat3 p = ff_moved(is_a ? at_a.p : at_b.p, way, dir);
            first = Root(0.0, is_a ? 0.0 : 1.0, ff_normalize(p));
        } else {
            vec2 sum = ff_add(mn, side * root);
            vec2 other = ff_sub(mn, side * root);
            way = side * mn.x < 0.0 ? ff_div(c, other) : bend.x != 0.0 ? ff_div(sum, bend) : vec2(0.0);
            TwoFloat3 p = ff_moved(mid.p, way, dir);
            vec2 height = ff_dot(p, u);
            precise float along = (by_b ? 1.0 : 0.0) + (off + ff_div(ff_add(height, ff_mul(delta, ball)), k).x);
            vec3 across = ff_normalize(ff_moved(p, -ff_div(height, uu), u));
            vec3 outward = normalize(sqrt(k.x / uu.x) * across - (delta.x / uu.x) * rounded(u));
            first = Root(0.0, clamp(along, 0.0, 1.0), outward);
        }
        first.t = ff_add(start, way).x * (speed * unit_of(unit));
        if (first.t > tmin) {
            return true;
        }
    }
    return false;
}
