// What a pixel sees of a checker board in the plane y = 0: filtered, at its middle, and by many rays.
#include "common/camera.glsl"
#include "common/plane.glsl"
#include "common/checker.glsl#checker_light"
#include "43_filtered_checker/board.glsl#footprint"

uniform vec3 eye;
uniform vec3 right;
uniform vec3 up;
uniform vec3 forward;
uniform uint side;

// How light the pixel is, filtered, at the middle and by many rays (-1 if one of them misses the board), and t, 0 for
// the sky: all in bits.
out uvec4 answer;

const int FINE = 12;
const Plane PLANE = Plane(vec3(0.0, 1.0, 0.0), vec2(0.0), vec3(0.0), 0.0);

float meet(vec3 direction) {
    float t;
    return plane_compensated(PLANE, eye, direction, t) && t > 0.0 ? t : 0.0;
}

void main() {
    CameraBasis camera = CameraBasis(eye, right, up, forward);
    // The picture's first line is the top one.
    vec2 point = vec2(gl_FragCoord.x, float(side) - gl_FragCoord.y);
    float sum = 0.0;
    for (int i = 0; i < FINE * FINE; i++) {
        vec2 offset = (vec2(i % FINE, i / FINE) + 0.5) / float(FINE) - 0.5;
        vec3 direction = ray_direction(camera, point + offset, uvec2(side));
        float t = meet(direction);
        sum = t == 0.0 ? -1e9 : sum + checker_light((eye + t * direction).xz, vec2(0.0));
    }

    // As camera.rgen and board.glsl of the chapter do it.
    vec3 direction = ray_direction(camera, point, uvec2(side));
    float t = meet(direction);
    float spread = 2.0 * length(up) / float(side) * dot(direction, forward);
    vec2 box = footprint(spread * t, direction, PLANE.normal, vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    vec2 middle = (eye + t * direction).xz;
    float many = max(sum / float(FINE * FINE), -1.0);
    answer = floatBitsToUint(vec4(checker_light(middle, box), checker_light(middle, vec2(0.0)), many, t));
}
