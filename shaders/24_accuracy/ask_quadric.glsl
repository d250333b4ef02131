// A ray against a quadric: the coefficients of x², y², z², then of yz, xz, xy, of x, y, z, and the rest.
#include "answer.glsl"
#include "quadric.glsl"
#include "quadric_two_float.glsl"

Quadric quadric_at(Numbers numbers, uint first) {
    return Quadric(vector_at(numbers, first), vector_at(numbers, first + 3), vector_at(numbers, first + 6),
        numbers.at[first + 9]);
}

Answer ask_quadric(uint rung, Query query, Numbers numbers) {
    Quadric quadric = quadric_at(numbers, query.first);
    Answer answer = NO_HIT;
    Roots roots;
#ifdef EXACT
    if (rung == QUADRIC_TWO_FLOAT) {
        bool met = quadric_two_float(quadric, query.origin, query.direction, query.tmin, query.tmax, roots, answer.normal);
        answer.hit = met ? 1 : 0;
        answer.t = roots.at.x;
        answer.count = roots.count;
        return answer;
    }
#endif
    roots = rung == QUADRIC_TEXTBOOK ? quadric_textbook(quadric, query.origin, query.direction)
                                     : quadric_stable(quadric, query.origin, query.direction);
    for (uint i = roots.count; i > 0; i--) {
        float t = roots.at[i - 1];
        if (t > query.tmin && t <= query.tmax) {
            answer.hit = 1;
            answer.count++;
            answer.t = t;
        }
    }
    if (answer.hit != 0) {
        answer.normal = unit(quadric_gradient(quadric, query.origin + answer.t * query.direction));
    }
    return answer;
}
