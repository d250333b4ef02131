// A ray against a cone between two discs: a.xyz, b.xyz, their radii, 1 if it is closed.
#include "answer.glsl"
#include "cone.glsl"
#include "cone_two_float.glsl"

Cone cone_at(Numbers numbers, uint first) {
    return Cone(vector_at(numbers, first), vector_at(numbers, first + 3), numbers.at[first + 6], numbers.at[first + 7],
        numbers.at[first + 8] != 0.0);
}

Answer ask_cone(uint rung, Query query, Numbers numbers) {
    Cone cone = cone_at(numbers, query.first);
    Answer answer = NO_HIT;
    Meeting m;
#ifdef EXACT
    if (rung == CONE_TWO_FLOAT) {
        cone_two_float(query.origin, query.direction, query.tmin, query.tmax, cone, m, answer.normal);
        answer.hit = m.count > 0 ? 1 : 0;
        answer.t = m.t;
        answer.count = m.count;
        return answer;
    }
#endif
    precise vec3 f = query.origin - cone.a;
    precise vec3 u = cone.b - cone.a;
    m = rung == CONE_TEXTBOOK ? cone_textbook(cone, f, query.direction, u, query.tmin, query.tmax)
                              : cone_stable(cone, f, query.direction, u, query.tmin, query.tmax);
    if (m.count > 0) {
        answer.hit = 1;
        answer.t = m.t;
        answer.count = m.count;
        answer.normal = unit(cone_normal(cone, f + m.t * query.direction, u, m.part));
    }
    return answer;
}
