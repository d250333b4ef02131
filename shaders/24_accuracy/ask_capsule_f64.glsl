// A ray against a capsule in 64 bits. After ask_capsule.glsl.
#include "capsule_f64.glsl"

Answer ask_capsule_f64(Query query, Numbers numbers) {
    uint first = query.first;
    Answer answer = NO_HIT;
    bool met = capsule_float64(query.origin, query.direction, query.tmin, query.tmax,
        vector_at(numbers, first), vector_at(numbers, first + 3), numbers.at[first + 6],
        answer.t, answer.normal);
    answer.hit = met ? 1 : 0;
    return answer;
}
