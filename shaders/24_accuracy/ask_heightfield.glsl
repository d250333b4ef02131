// A ray against a landscape: k, a, fx, fz, b, gx, gz, lipschitz.
#include "answer.glsl"
#include "common/heightfield.glsl"

Answer ask_heightfield(uint rung, Query query, Numbers numbers) {
    uint first = query.first;
    HeightfieldShape shape = HeightfieldShape(
        numbers.at[first], numbers.at[first + 1], numbers.at[first + 2], numbers.at[first + 3],
        numbers.at[first + 4], numbers.at[first + 5], numbers.at[first + 6], numbers.at[first + 7]);
    HeightfieldHit hit =
        heightfield_by(rung, shape, query.origin, query.direction, query.tmin, query.tmax);
    Answer answer = NO_HIT;
    answer.count = hit.steps;
    if (hit.met) {
        vec3 point = query.origin + hit.t * query.direction;
        answer.hit = 1;
        answer.t = hit.t;
        answer.normal = heightfield_normal(shape, point.xz);
    }
    return answer;
}
