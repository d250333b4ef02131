// A ray against a torus in two-floats: common/brackets.glsl step by step, with twice the bits, and the polynomial never
// expanded.
//
// On the torus G = Q² + w·Z² - v is 0, where Q = |p|² - R² - r², Z = p·n, w = 4R²/n·n and v = 4R²r². Along the
// line p + x·d, Q is a quadratic and Z is linear. Near the tube no term is larger than about v, however thin it
// is, while the coefficients of the expanded polynomial are about R⁴.
//
// Numbers in two floats are those of chapter 24, and so is what they need: rounding to nearest, `precise`.
#include "common/two_float.glsl"

struct Exact {
    vec2 dd;      // Q = dd·x² + 2·pd·x + m
    vec2 pd;
    vec2 m;
    vec2 h;       // Z = h + rate·x
    vec2 rate;
    vec2 w;
    vec2 v;
};

vec2 ff_z(const Exact e, vec2 x) {
    return ff_add(e.h, ff_mul(e.rate, x));
}

vec2 ff_q(const Exact e, vec2 x) {
    vec2 upper = ff_add(ff_mul(e.dd, x), 2.0 * e.pd);
    return ff_add(ff_mul(upper, x), e.m);
}

// ANCHOR: value
// G, or half of its derivative.
vec2 ff_value(const Exact e, bool is_slope, vec2 x) {
    vec2 z = ff_z(e, x);
    vec2 q = ff_q(e, x);
    vec2 wz = ff_mul(e.w, z);
    if (is_slope) {
        vec2 half_rate = ff_add(ff_mul(e.dd, x), e.pd);
        return ff_add(2.0 * ff_mul(q, half_rate), ff_mul(wz, e.rate));
    }
    vec3 sum = vec3(-e.v, 0.0);
    sum_add_product(sum, q, q);
    sum_add_product(sum, wz, z);
    return sum_total(sum);
}
// ANCHOR_END: value

// The derivative of ff_value(), rounded: it only decides how fast Newton's method converges.
float rough_slope(const Exact e, bool is_slope, float x) {
    float half_rate = e.dd.x * x + e.pd.x;
    float q = (e.dd.x * x + 2.0 * e.pd.x) * x + e.m.x;
    float z = e.h.x + e.rate.x * x;
    if (is_slope) {
        return 4.0 * half_rate * half_rate + 2.0 * q * e.dd.x + e.w.x * e.rate.x * e.rate.x;
    }
    return 2.0 * (2.0 * q * half_rate + e.w.x * z * e.rate.x);
}

bool ff_negative(vec2 a) {
    return a.x <= 0.0;
}

const int TWO_FLOAT_STEPS = 60;
const float LAST_STEP = 2.8421709e-14;    // 2^-45, in units of R

vec2 ff_root_between(const Exact e, bool is_slope, vec2 low, vec2 high, bool negative_at_low) {
    vec2 x = 0.5 * ff_add(low, high);
    for (int i = 0; i < TWO_FLOAT_STEPS; i++) {
        vec2 y = ff_value(e, is_slope, x);
        if (ff_negative(y) == negative_at_low) {
            low = x;
        } else {
            high = x;
        }
        precise float step = -y.x / rough_slope(e, is_slope, x.x);
        vec2 next = ff_add(x, vec2(step, 0.0));
        if (abs(step) <= LAST_STEP && !ff_less(next, low) && !ff_less(high, next)) {
            return next;
        }
        if (!(ff_less(low, next) && ff_less(next, high))) {
            next = 0.5 * ff_add(low, high);
            if (!(ff_less(low, next) && ff_less(next, high))) {
                break;
            }
        }
        x = next;
    }
    return x;
}

// The sum of start, a·s and b·s for two steps along d, each product exact, before it is rounded to a two-float.
vec2 ff_moved(vec2 start, vec2 steps, float d) {
    vec3 sum = vec3(start, 0.0);
    sum_add_product(sum, steps, d);
    return sum_total(sum);
}

TwoFloat3 ff_moved(TwoFloat3 start, vec2 steps, vec3 d) {
    return TwoFloat3(ff_moved(start.x, steps, d.x), ff_moved(start.y, steps, d.y), ff_moved(start.z, steps, d.z));
}

// Ring and normal, as crossing_at(), from two-floats: for a thin tube, 32 bits of |across| - R say little.
TorusCrossing ff_crossing(float t, TwoFloat3 p, vec2 h, vec3 n, vec2 nn, float major, vec3 d) {
    vec2 along = ff_div(h, nn);
    TwoFloat3 axial = TwoFloat3(ff_mul(along, n.x), ff_mul(along, n.y), ff_mul(along, n.z));
    TwoFloat3 across = ff_sub(p, axial);
    vec2 size = ff_sqrt(ff_dot(across, across));
    if (!(size.x > 0.0)) {
        return TorusCrossing(t, vec3(0.0), -normalize(d));
    }
    float from_ring = ff_sub(size, vec2(major, 0.0)).x;
    vec3 ring = rounded(across) / size.x;
    precise vec3 outward = from_ring * ring + rounded(axial);
    float largest = max(max(abs(outward.x), abs(outward.y)), abs(outward.z));
    return TorusCrossing(t, ring, largest > 0.0 ? normalize(outward / largest) : -normalize(d));
}

bool torus_two_float(vec3 o, vec3 d, Torus torus, float tmin, out TorusCrossing first) {
    first = TorusCrossing(0.0, vec3(0.0), vec3(0.0));
    // Powers of two that bring lengths near 1: a product with them rounds nothing.
    int size = exponent_of(torus.major);
    int speed = exponent_of(d);
    d = scaled(d, -speed);
    vec3 n = scaled(torus.axis, -exponent_of(torus.axis));
    float major = scaled(torus.major, -size);
    float minor = scaled(torus.minor, -size);
    TwoFloat3 f = scaled(ff_difference(o, torus.center), -size);

    // The origin moves by two floats. Each product with d and all sums are exact to 72 bits, so that the distance
    // to the ray's origin costs nothing.
    Exact e;
    e.dd = ff_dot(ff_vector(d), d);
    vec3 rough = rounded(f);
    precise float step = -dot(rough, d) / e.dd.x;
    TwoFloat3 p = ff_moved(f, vec2(step, 0.0), d);
    precise float rest = -ff_dot(p, d).x / e.dd.x;
    vec2 base = two_sum(step, rest);
    p = ff_moved(f, base, d);

    vec2 rr = two_product(major, major);
    vec2 minor_squared = two_product(minor, minor);
    vec2 nn = ff_dot(ff_vector(n), n);
    e.pd = ff_dot(p, d);
    vec2 pp = ff_dot(p, p);
    e.m = ff_sub(ff_sub(pp, rr), minor_squared);
    e.h = ff_dot(p, n);
    e.rate = ff_dot(ff_vector(d), n);
    e.w = 4.0 * ff_div(rr, nn);
    e.v = 4.0 * ff_mul(rr, minor_squared);

    // The ball around the torus bounds the search; it is taken a little larger.
    precise float outer = 1.000001 * (major + minor);
    precise float chord = (outer * outer - pp.x) / e.dd.x;
    if (!(chord >= 0.0)) {
        return false;
    }
    precise float reach = sqrt(chord);
    // tmin, as the line's own parameter.
    int faster = size - speed;
    vec2 above = ff_sub(vec2(scaled(tmin, -faster), 0.0), base);
    vec2 low = ff_less(above, vec2(-reach, 0.0)) ? vec2(-reach, 0.0) : above;
    vec2 high = vec2(reach, 0.0);
    if (!ff_less(low, high)) {
        return false;
    }

    // Where G'' is 0: x² + 2b·x + c, with b almost 0.
    precise float b = e.pd.x / e.dd.x;
    vec2 constant = ff_add(4.0 * ff_mul(e.pd, e.pd), 2.0 * ff_mul(e.dd, e.m));
    constant = ff_add(constant, ff_mul(e.w, ff_mul(e.rate, e.rate)));
    precise float c = constant.x / (6.0 * e.dd.x * e.dd.x);
    vec2 ends[5] = vec2[5](low, high, high, high, high);
    int count = 2;
    vec2 flat_places;
    if (quadratic(b, c, flat_places)) {
        for (int i = 0; i < 2; i++) {
            vec2 place = vec2(flat_places[i], 0.0);
            place = ff_less(place, low) ? low : ff_less(high, place) ? high : place;
            ends[i + 1] = place;
        }
        count = 4;
    }
    // First the places where G' is 0, then those where G is. One loop for both, so that the code exists once.
    vec2 x = low;
    float t = 0.0;
    bool hit = false;
    for (int pass = 0; pass < 2 && !hit; pass++) {
        bool is_slope = pass == 0;
        int found = 1;
        vec2 from = low;
        bool negative = false;
        for (int i = 0; i < count && !hit; i++) {
            vec2 to = ends[i];
            bool then = ff_negative(ff_value(e, is_slope, to));
            if (i > 0 && then != negative) {
                x = ff_root_between(e, is_slope, from, to, negative);
                t = scaled(ff_add(base, x).x, faster);
                hit = !is_slope && t > tmin;
                if (is_slope) {
                    ends[found] = x;
                    found++;
                }
            }
            from = to;
            negative = then;
        }
        if (is_slope) {
            ends[found] = high;
            count = found + 1;
        }
    }
    if (!hit) {
        return false;
    }
    TwoFloat3 at = TwoFloat3(ff_add(p.x, ff_mul(x, d.x)), ff_add(p.y, ff_mul(x, d.y)), ff_add(p.z, ff_mul(x, d.z)));
    first = ff_crossing(t, at, ff_z(e, x), n, nn, major, d);
    return true;
}
