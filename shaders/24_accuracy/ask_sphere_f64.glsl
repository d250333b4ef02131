// A ray against a sphere in 64 bits. After ask_sphere.glsl.
#include "sphere_f64.glsl"

Answer ask_sphere_f64(Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    bool met = sphere_float64(query.origin, query.direction, query.tmin, query.tmax,
        vector_at(numbers, query.first), numbers.at[query.first + 3], answer.t, answer.normal);
    answer.hit = met ? 1 : 0;
    return answer;
}
