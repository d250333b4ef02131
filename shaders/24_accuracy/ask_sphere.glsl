// A ray against a sphere: center.xyz, radius, c = |o - center|² - radius² from 64 bits.
#include "answer.glsl"
#include "common/sphere.glsl"
#include "sphere_two_float.glsl"

bool sphere_by(uint rung, vec3 f, vec3 d, float r, float c, out vec2 t) {
    switch (rung) {
        case SPHERE_TEXTBOOK: return sphere_textbook(f, d, r, t);
        case SPHERE_PROJECTION: return sphere_projection(f, d, r, t);
        case SPHERE_HOST_C: return sphere_host_c(f, d, c, t);
        case SPHERE_OFFERED: return sphere_offered(f, d, t);
        case SPHERE_COMPENSATED: return sphere_compensated(f, d, r, t);
        default: return sphere_stable(f, d, r, t);
    }
}

Answer ask_sphere(uint rung, Query query, Numbers numbers) {
    vec3 center = vector_at(numbers, query.first);
    float radius = numbers.at[query.first + 3];
    Answer answer = NO_HIT;
#ifdef EXACT
    if (rung == SPHERE_TWO_FLOAT) {
        bool met = sphere_two_float(query.origin, query.direction, query.tmin, query.tmax,
            center, radius, answer.t, answer.normal);
        answer.hit = met ? 1 : 0;
        return answer;
    }
#endif
    precise vec3 f = query.origin - center;
    vec2 t;
    bool enters;
    if (sphere_by(rung, f, query.direction, radius, numbers.at[query.first + 4], t)
        && first_root(t, query, enters)) {
        answer.hit = 1;
        answer.t = enters ? t.x : t.y;
        answer.normal = unit(f + answer.t * query.direction);
    }
    return answer;
}
