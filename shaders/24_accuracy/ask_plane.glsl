// A ray against a plane: normal.xyz, D·|N| in two floats, anchor.xyz, rest.
#include "answer.glsl"
#include "plane_two_float.glsl"

Plane plane_at(Numbers numbers, uint first) {
    return Plane(
        vector_at(numbers, first),
        vec2(numbers.at[first + 3], numbers.at[first + 4]),
        vector_at(numbers, first + 5),
        numbers.at[first + 8]);
}

Answer ask_plane(uint rung, Query query, Numbers numbers) {
    Plane plane = plane_at(numbers, query.first);
    Answer answer = NO_HIT;
#ifdef EXACT
    if (rung == PLANE_TWO_FLOAT) {
        bool met = plane_two_float(plane, query.origin, query.direction, query.tmin, query.tmax,
            answer.t, answer.normal);
        answer.hit = met ? 1 : 0;
        return answer;
    }
#endif
    float t;
    if (plane_by(rung, plane, query.origin, query.direction, t)
        && t > query.tmin && t <= query.tmax) {
        answer.hit = 1;
        answer.t = t;
        vec3 normal = unit(plane.normal);
        answer.normal = faceforward(normal, query.direction, normal);
    }
    return answer;
}
