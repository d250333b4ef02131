// A ray against a plane in two-floats: the rung above those of plane.glsl.
#include "common/plane.glsl"
#include "common/two_float.glsl"

const uint PLANE_TWO_FLOAT = 4;

// The hit with tmin < t <= tmax, by the point close by: the difference, all products and their sum with
// no error that reaches t. The normal is on the side that the ray comes from.
bool plane_two_float(
    Plane plane, vec3 o, vec3 d, float tmin, float tmax, out float t, out vec3 normal) {
    t = 0.0;
    normal = vec3(0.0);
    // All lengths become about 1: those of N and d, which need not be, and that of the height.
    int slant = exponent_of(plane.normal);
    int speed = exponent_of(d);
    int size = exponent_of(max(abs(o), abs(plane.anchor)));
    TwoFloat3 n = ff_vector(scaled(plane.normal, -slant));
    TwoFloat3 to_plane = ff_difference(scaled(plane.anchor, -size), scaled(o, -size));
    vec3 sum = vec3(scaled(scaled(plane.rest, -slant), -size), 0.0, 0.0);
    sum_add_product(sum, to_plane.x, n.x);
    sum_add_product(sum, to_plane.y, n.y);
    sum_add_product(sum, to_plane.z, n.z);
    vec2 height = sum_total(sum);
    vec2 slope = ff_dot(n, scaled(d, -speed));
    if (slope.x == 0.0 || height.x == 0.0) {
        return false;
    }
    // Near the horizon the slope may be as small as a float can be: divided last, by its power of two.
    int high = exponent_of(height.x);
    int steep = exponent_of(slope.x);
    vec2 quotient = ff_div(scaled(height, -high), scaled(slope, -steep));
    vec2 exact = scaled(quotient, high - steep + size - speed);
    if (!ff_within(exact, tmin, tmax)) {
        return false;
    }
    t = exact.x;
    normal = ff_normalize(n);
    normal = slope.x > 0.0 ? -normal : normal;
    return true;
}
