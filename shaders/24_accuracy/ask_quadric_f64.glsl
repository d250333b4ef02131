// A ray against a quadric in 64 bits. After ask_quadric.glsl.
#include "quadric_f64.glsl"

Answer ask_quadric_f64(Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    Roots roots;
    bool met = quadric_float64(quadric_at(numbers, query.first), query.origin, query.direction, query.tmin, query.tmax,
        roots, answer.normal);
    answer.hit = met ? 1 : 0;
    answer.t = roots.at.x;
    answer.count = roots.count;
    return answer;
}
