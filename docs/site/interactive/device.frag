// A pixel asks one rung for one ray, or some operations for one set of operands.
#include "common/sphere.glsl#sphere_textbook"
#include "common/sphere.glsl#sphere_stable"
#include "common/two_float.glsl"
#include "24_accuracy/sphere_two_float.glsl#roots"
#include "24_accuracy/sphere_two_float.glsl#sphere_two_float"
const float LARGEST = 3.4028234e38;
#include "common/box.glsl#box_reciprocal"
#include "common/box.glsl#box_division"
#include "24_accuracy/box_two_float.glsl"

uniform uvec4 given[128];   // two for each pixel, in bits: ray or operands
uniform vec3 low;
uniform vec3 high;
uniform uint subject;
uniform uint rung;

out uvec4 answer;

void main() {
    uint pixel = uint(gl_FragCoord.y) * 8u + uint(gl_FragCoord.x);
    vec3 o = uintBitsToFloat(given[2u * pixel].xyz);
    vec3 d = uintBitsToFloat(given[2u * pixel + 1u].xyz);
    if (subject == 2) {
        precise float product = o.x * o.y;
        if (rung == 0) {
            answer = floatBitsToUint(vec4(o.x + o.y, o.x * o.y, o.x / o.y, 1.0 / o.x));
        } else if (rung == 1) {
            answer = floatBitsToUint(vec4(sqrt(o.x), inversesqrt(o.x), o.x * o.y + o.z, product + o.z));
        } else {
            answer = floatBitsToUint(vec4(two_sum(o.x, o.y), two_product(o.x, o.y)));
        }
        return;
    }
    vec2 t = vec2(0.0);
    vec3 normal;
    vec3 faces[2];
    bool hit;
    if (subject == 0) {
        if (rung == 0) {
            hit = sphere_textbook(o, d, 1.0, t);
        } else if (rung == 1) {
            hit = sphere_stable(o, d, 1.0, t);
        } else {
            hit = sphere_two_float(o, d, 0.0, 3e38, vec3(0.0), 1.0, t.x, normal);
        }
    } else if (rung == 0) {
        hit = box_reciprocal(o, d, low, high, t, faces);
    } else if (rung == 1) {
        hit = box_division(o, d, low, high, t, faces);
    } else {
        hit = box_two_float(o, d, 0.0, 3e38, low, high, t.x, normal);
    }
    // The first root that lies on the ray.
    float first = t.x > 0.0 ? t.x : t.y;
    if (!(hit && first > 0.0)) {
        answer = uvec4(0u);
        return;
    }
    answer = uvec4(1u, floatBitsToUint(first), 0u, 0u);
}
