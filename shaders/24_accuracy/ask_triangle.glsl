// A ray against a mesh: nine numbers per triangle.
#include "answer.glsl"
#include "common/triangle.glsl"

Answer ask_triangle(uint rung, Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    answer.t = query.tmax;
    for (uint first = query.first; first + 9 <= query.first + query.count; first += 9) {
        vec3 a = vector_at(numbers, first);
        vec3 b = vector_at(numbers, first + 3);
        vec3 c = vector_at(numbers, first + 6);
        float t;
        vec3 normal;
#ifdef EXACT
        if (rung == TRIANGLE_TWO_FLOAT) {
            if (triangle_two_float(
                    a, b, c, query.origin, query.direction, query.tmin, answer.t, t, normal)) {
                answer.hit = 1;
                answer.t = t;
                answer.normal = normal;
            }
            continue;
        }
#endif
        bool met = rung == TRIANGLE_MOELLER
            ? triangle_moeller(a, b, c, query.origin, query.direction, t)
            : triangle_woop(a, b, c, query.origin, query.direction, t);
        if (met && t > query.tmin && t <= answer.t) {
            answer.hit = 1;
            answer.t = t;
            normal = unit(cross(b - a, c - a));
            answer.normal = faceforward(normal, query.direction, normal);
        }
    }
    return answer;
}
