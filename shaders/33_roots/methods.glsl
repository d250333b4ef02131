// The first crossing of a ray with a torus, by one of four methods.
#include "common/torus_quartic.glsl"
#include "common/brackets.glsl"
#include "quartic.glsl"
#include "sturm.glsl"
#include "two_float_torus.glsl"

const uint METHOD_FERRARI = 0;
const uint METHOD_BRACKETS = 1;
const uint METHOD_STURM = 2;
const uint METHOD_TWO_FLOAT = 3;

// ANCHOR: expanded
// The polynomial as it comes from the formula, seen from the ray's origin. From a distance D its constant term
// is about D⁴, and a hit differs from a miss by no more than 4R²·r².
Quartic quartic_from_origin(vec3 f, vec3 d, vec3 n, float major, float minor) {
    precise float dd = dot(d, d);
    precise float fd = dot(f, d);
    precise float k = dot(f, f) + major * major - minor * minor;
    precise float h = dot(f, n);
    precise float rate = dot(d, n);
    precise float four = 4.0 * major * major;
    precise float c0 = k * k - four * (dot(f, f) - h * h);
    precise float c1 = 4.0 * fd * k - 2.0 * four * (fd - h * rate);
    precise float c2 = 4.0 * fd * fd + 2.0 * dd * k - four * (dd - rate * rate);
    precise float c3 = 4.0 * dd * fd;
    precise float c4 = dd * dd;
    return Quartic(float[5](c0, c1, c2, c3, c4));
}
// ANCHOR_END: expanded

// ANCHOR: torus_first
// The methods in 32 bits: the first root beyond tmin, for the direction as given. Without `conditioned` the polynomial is seen
// from the ray's origin.
bool torus_single(uint method, bool conditioned, vec3 o, vec3 d, Torus torus, float tmin, out TorusCrossing first) {
    first = TorusCrossing(0.0, vec3(0.0), vec3(0.0));
    precise vec3 f = o - torus.center;
    vec3 n = normalize(torus.axis);
    float minor = torus.minor / torus.major;
    Line line = line_near(f, d, torus.major);
    float reach;
    if (!reach_in_ball(line, minor, reach)) {
        return false;
    }
    Quartic q = conditioned ? quartic_at_foot(line, n, minor)
                            : quartic_from_origin(f, d, n, torus.major, torus.minor);
    // x is what the polynomial is in, t = start + x·unit.
    float start = conditioned ? line.t : 0.0;
    float unit = conditioned ? line.unit : 1.0;
    precise float above = (tmin - start) / unit;
    precise float middle = conditioned ? 0.0 : line.t;
    precise float half_chord = conditioned ? reach : reach * line.unit;
    precise float low = max(middle - half_chord, above);
    precise float high = middle + half_chord;
    if (!(low < high)) {
        return false;
    }
    float x = 0.0;
    bool hit = false;
    if (method == METHOD_FERRARI) {
        vec4 roots;
        int count = ferrari(q, roots);
        for (int i = 0; i < 4 && !hit; i++) {
            x = roots[i];
            hit = i < count && x > above && x <= high;
        }
    } else if (method == METHOD_STURM) {
        hit = first_by_sturm(q, low, high, x);
    } else {
        hit = first_root(q, low, high, above, x);
    }
    precise float t = start + x * unit;
    precise vec3 p = conditioned ? line.p + x * line.d : line.p + (t - line.t) / line.unit * line.d;
    if (hit && t > tmin) {
        first = crossing_at(t, p, n, d);
    }
    return hit && t > tmin;
}
// ANCHOR_END: torus_first

bool torus_crossing(uint method, bool conditioned, vec3 o, vec3 d, Torus torus, float tmin, out TorusCrossing first) {
    return method == METHOD_TWO_FLOAT ? torus_two_float(o, d, torus, tmin, first)
                                      : torus_single(method, conditioned, o, d, torus, tmin, first);
}
