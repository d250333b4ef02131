// The ray of a pixel, and where it meets the sphere of radius 1 around the origin by one rung.
#include "common/camera.glsl"
#include "common/sphere.glsl#sphere_textbook"
#include "common/sphere.glsl#sphere_stable"
#include "common/two_float.glsl"
#include "24_accuracy/sphere_two_float.glsl#roots"
#include "24_accuracy/sphere_two_float.glsl#sphere_two_float"

uniform vec3 eye;
uniform vec3 right;
uniform vec3 up;
uniform vec3 forward;
uniform uint side;
uniform uint rung;

// t, 0 for a miss, and the direction, all in bits: the script computes the exact t of this very ray.
out uvec4 answer;

void main() {
    // The picture's first line is the top one.
    vec2 point = vec2(gl_FragCoord.x, float(side) - gl_FragCoord.y);
    vec3 d = ray_direction(CameraBasis(eye, right, up, forward), point, uvec2(side));
    vec2 t = vec2(0.0);
    if (rung == 0) {
        sphere_textbook(eye, d, 1.0, t);
    } else if (rung == 1) {
        sphere_stable(eye, d, 1.0, t);
    } else {
        vec3 normal;
        sphere_two_float(eye, d, 0.0, 3e38, vec3(0.0), 1.0, t.x, normal);
    }
    answer = uvec4(floatBitsToUint(t.x), floatBitsToUint(d));
}
