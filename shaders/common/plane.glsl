// Taught by 24_accuracy.
//
// A ray against a plane, in four ways that are equal on paper.
//
// o is the ray's origin, d its direction of any length. Where the ray's line meets the plane goes to
// `t`, behind the origin as well as before it; the answer is whether it does.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

#include "error_free.glsl"

const uint PLANE_POV = 0;
const uint PLANE_POINT = 1;
const uint PLANE_CUT_OFF = 2;
const uint PLANE_COMPENSATED = 3;

// All points p with N·p = D·|N|, said twice: from the world's origin and from a point close by.
struct Plane {
    vec3 normal;     // N: any length but 0, points to the outside
    vec2 distance;   // D·|N|, and what rounding it to 32 bits left over
    vec3 anchor;     // a point of the plane near the camera, rounded
    float rest;      // D·|N| - N·anchor: how far the rounding moved it off the plane, times |N|
};

// As the plane is given: {<A,B,C>, D}. How high the origin is above the plane is the difference of two
// numbers that both grow with the distance from the world's origin.
bool plane_pov(Plane plane, vec3 o, vec3 d, out float t) {
    precise float height = plane.distance.x - dot(o, plane.normal);
    precise float slope = dot(d, plane.normal);
    precise float quotient = height / slope;
    t = slope == 0.0 ? 0.0 : quotient;
    return slope != 0.0;
}

// By a point of the plane. Near the ray's origin, it makes the subtraction exact: what would cancel has been
// subtracted by the host, in 64 bits.
bool plane_point(Plane plane, vec3 o, vec3 d, out float t) {
    precise vec3 to_plane = plane.anchor - o;
    precise float height = dot(to_plane, plane.normal) + plane.rest;
    precise float slope = dot(d, plane.normal);
    precise float quotient = height / slope;
    t = slope == 0.0 ? 0.0 : quotient;
    return slope != 0.0;
}

// The same, but a ray that is nearly parallel is taken for parallel: a common guard against dividing by
// a small number. There is nothing to guard against, and the horizon is lost.
bool plane_cut_off(Plane plane, vec3 o, vec3 d, out float t) {
    float sine = dot(normalize(d), normalize(plane.normal));
    return plane_point(plane, o, d, t) && abs(sine) >= 1e-3;
}

// As the plane is given, with sums as good as if they had twice the bits.
bool plane_compensated(Plane plane, vec3 o, vec3 d, out float t) {
    precise float height = dot_compensated(plane.distance, -o, plane.normal);
    precise float slope = dot_compensated(vec2(0.0), d, plane.normal);
    precise float quotient = height / slope;
    t = slope == 0.0 ? 0.0 : quotient;
    return slope != 0.0;
}

bool plane_by(uint rung, Plane plane, vec3 o, vec3 d, out float t) {
    switch (rung) {
        case PLANE_POV: return plane_pov(plane, o, d, t);
        case PLANE_POINT: return plane_point(plane, o, d, t);
        case PLANE_CUT_OFF: return plane_cut_off(plane, o, d, t);
        default: return plane_compensated(plane, o, d, t);
    }
}
