// A ray against a cone in 64 bits. After ask_cone.glsl.
#include "cone_f64.glsl"

Answer ask_cone_f64(Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    Meeting m;
    bool met = cone_float64(query.origin, query.direction, query.tmin, query.tmax, cone_at(numbers, query.first),
        m, answer.normal);
    answer.hit = met ? 1 : 0;
    answer.t = m.t;
    answer.count = m.count;
    return answer;
}
