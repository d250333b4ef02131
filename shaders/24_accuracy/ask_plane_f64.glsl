// A ray against a plane in 64 bits. After ask_plane.glsl.
#include "plane_f64.glsl"

Answer ask_plane_f64(Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    bool met = plane_float64(plane_at(numbers, query.first), query.origin, query.direction,
        query.tmin, query.tmax, answer.t, answer.normal);
    answer.hit = met ? 1 : 0;
    return answer;
}
