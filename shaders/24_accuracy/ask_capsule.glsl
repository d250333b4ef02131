// A ray against a capsule: a.xyz, b.xyz, radius.
#include "answer.glsl"
#include "capsule.glsl"
#include "capsule_two_float.glsl"

Answer ask_capsule(uint rung, Query query, Numbers numbers) {
    vec3 a = vector_at(numbers, query.first);
    vec3 b = vector_at(numbers, query.first + 3);
    float radius = numbers.at[query.first + 6];
    Answer answer = NO_HIT;
#ifdef EXACT
    if (rung == CAPSULE_TWO_FLOAT) {
        bool met = capsule_two_float(query.origin, query.direction, query.tmin, query.tmax,
            a, b, radius, answer.t, answer.normal);
        answer.hit = met ? 1 : 0;
        return answer;
    }
#endif
    precise vec3 f = query.origin - a;
    precise vec3 axis = b - a;
    vec2 t;
    bool enters;
    bool met = rung == CAPSULE_TEXTBOOK ? capsule_textbook(f, query.direction, axis, radius, t)
                                        : capsule_stable(f, query.direction, axis, radius, t);
    if (met && first_root(t, query, enters)) {
        answer.hit = 1;
        answer.t = enters ? t.x : t.y;
        answer.normal = unit(capsule_normal(f + answer.t * query.direction, axis));
    }
    return answer;
}
