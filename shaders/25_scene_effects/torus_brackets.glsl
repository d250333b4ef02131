// A ray against a torus, by the method *brackets* of chapter 33: the polynomial is seen from the foot.
#include "common/torus_quartic.glsl"
#include "common/brackets.glsl"

// The first crossing beyond tmin, for the direction as given: t, and the point from the centre in units of R.
bool torus_by_brackets(vec3 o, vec3 d, Torus torus, float tmin, out float t, out vec3 p) {
    t = 0.0;
    p = vec3(0.0);
    precise vec3 f = o - torus.center;
    vec3 n = normalize(torus.axis);
    float minor = torus.minor / torus.major;
    Line line = line_near(f, d, torus.major);
    float reach;
    if (!reach_in_ball(line, minor, reach)) {
        return false;
    }
    precise float above = (tmin - line.t) / line.unit;
    float low = max(-reach, above);
    float x;
    if (!(low < reach) || !first_root(quartic_at_foot(line, n, minor), low, reach, above, x)) {
        return false;
    }
    precise float first = line.t + x * line.unit;
    precise vec3 point = line.p + x * line.d;
    t = first;
    p = point;
    return t > tmin;
}
