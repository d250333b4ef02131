// The first crossing of a ray with a torus, by one of four methods.
#include "torus.glsl"
#include "quartic.glsl"
#include "brackets.glsl"
#include "sturm.glsl"
#include "two_float_torus.glsl"

// ANCHOR: torus_first
// The methods in 32 bits: the first root beyond tmin, for the direction as given. Without `conditioned` the polynomial is seen
// from the ray's origin.
bool torus_single(uint method, bool conditioned, vec3 o, vec3 d, Torus torus, float tmin, out Crossing first) {
    first = Crossing(0.0, vec3(0.0), vec3(0.0));
    precise vec3 f = o - torus.center;
    vec3 n = normalize(torus.axis);
    float minor = torus.minor / torus.major;
    Line line = line_near(f, d, torus.major);
    // The search ends where the line leaves the ball around the torus.
    precise float reach = (1.0 + minor) * (1.0 + minor) - dot(line.p, line.p);
    if (!(reach >= -1e-4)) {
        return false;
    }
    reach = sqrt(max(reach, 0.0)) + 0.001;
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

bool torus_crossing(uint method, bool conditioned, vec3 o, vec3 d, Torus torus, float tmin, out Crossing first) {
    return method == METHOD_TWO_FLOAT ? torus_two_float(o, d, torus, tmin, first)
                                      : torus_single(method, conditioned, o, d, torus, tmin, first);
}
