// A ray against a plane, in four ways that are equal on paper.
//
// o is the ray's origin, d its direction of any length. Where the ray's line meets the plane goes to
// `t`, behind the origin as well as before it; the answer is whether it does.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

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

// ANCHOR: pov
// As the plane is given: {<A,B,C>, D}. How high the origin is above the plane is the difference of two
// numbers that both grow with the distance from the world's origin.
bool plane_pov(Plane plane, vec3 o, vec3 d, out float t) {
    precise float height = plane.distance.x - dot(o, plane.normal);
    precise float slope = dot(d, plane.normal);
    precise float quotient = height / slope;
    t = slope == 0.0 ? 0.0 : quotient;
    return slope != 0.0;
}
// ANCHOR_END: pov

// ANCHOR: point
// By a point of the plane. Near the origin, it makes the subtraction exact: what would cancel has been
// subtracted by the host, in 64 bits.
bool plane_point(Plane plane, vec3 o, vec3 d, out float t) {
    precise vec3 to_plane = plane.anchor - o;
    precise float height = dot(to_plane, plane.normal) + plane.rest;
    precise float slope = dot(d, plane.normal);
    precise float quotient = height / slope;
    t = slope == 0.0 ? 0.0 : quotient;
    return slope != 0.0;
}
// ANCHOR_END: point

// ANCHOR: cut_off
// The same, but a ray that is nearly parallel is taken for parallel: a common guard against dividing by
// a small number. There is nothing to guard against, and the horizon is lost.
bool plane_cut_off(Plane plane, vec3 o, vec3 d, out float t) {
    float sine = dot(normalize(d), normalize(plane.normal));
    return plane_point(plane, o, d, t) && abs(sine) >= 1e-3;
}
// ANCHOR_END: cut_off

// ANCHOR: exact
// a + b is sum.x + sum.y, exactly (Knuth).
vec2 two_sum(float a, float b) {
    precise float sum = a + b;
    precise float back = sum - a;
    precise float error = (a - (sum - back)) + (b - back);
    return vec2(sum, error);
}

// The upper 12 bits of a number and the lower 12: products of such halves are exact (Veltkamp).
vec2 split(float a) {
    precise float wide = 4097.0 * a;
    precise float high = wide - (wide - a);
    precise float low = a - high;
    return vec2(high, low);
}

// a·b is product.x + product.y, exactly (Dekker). Not by fma(), which GLSL allows to round twice.
vec2 two_product(float a, float b) {
    vec2 x = split(a);
    vec2 y = split(b);
    precise float product = a * b;
    precise float error = ((x.x * y.x - product) + x.x * y.y + x.y * y.x) + x.y * y.y;
    return vec2(product, error);
}
// ANCHOR_END: exact

// ANCHOR: compensated
// start + a·b, where the error of each product and of each sum is kept, and added at the end.
// (Ogita, Rump and Oishi 2005, algorithm Dot2.)
float dot_compensated(vec2 start, vec3 a, vec3 b) {
    precise float sum = start.x;
    precise float error = start.y;
    for (int i = 0; i < 3; i++) {
        vec2 product = two_product(a[i], b[i]);
        vec2 next = two_sum(sum, product.x);
        sum = next.x;
        error += product.y + next.y;
    }
    precise float result = sum + error;
    return result;
}

// As the plane is given, with sums as good as if they had twice the bits.
bool plane_compensated(Plane plane, vec3 o, vec3 d, out float t) {
    precise float height = dot_compensated(plane.distance, -o, plane.normal);
    precise float slope = dot_compensated(vec2(0.0), d, plane.normal);
    precise float quotient = height / slope;
    t = slope == 0.0 ? 0.0 : quotient;
    return slope != 0.0;
}
// ANCHOR_END: compensated

bool plane_by(uint rung, Plane plane, vec3 o, vec3 d, out float t) {
    switch (rung) {
        case PLANE_POV: return plane_pov(plane, o, d, t);
        case PLANE_POINT: return plane_point(plane, o, d, t);
        case PLANE_CUT_OFF: return plane_cut_off(plane, o, d, t);
        default: return plane_compensated(plane, o, d, t);
    }
}
