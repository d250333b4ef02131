// A ray against a box in 64 bits. After ask_box.glsl.
#include "box_f64.glsl"

Answer ask_box_f64(Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    bool met = box_float64(query.origin, query.direction, query.tmin, query.tmax,
        vector_at(numbers, query.first), vector_at(numbers, query.first + 3), answer.t, answer.normal);
    answer.hit = met ? 1 : 0;
    return answer;
}
