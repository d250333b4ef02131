// A ray against an algebraic surface: the box's low corner, its high one, and 35 coefficients.
#include "answer.glsl"
#include "algebraic.glsl"
#include "algebraic_two_float.glsl"

Algebraic algebraic_from(Numbers numbers, uint first) {
    return Algebraic(vector_at(numbers, first), vector_at(numbers, first + 3), numbers, first + 6);
}

Answer algebraic_answer(Algebraic a, Query query, AlgebraicHits hits) {
    Answer answer = NO_HIT;
    if (hits.count > 0) {
        answer.hit = 1;
        answer.t = hits.t;
        answer.count = hits.count;
        answer.normal = unit(algebraic_gradient(a, query.origin + hits.t * query.direction));
    }
    return answer;
}

Answer ask_algebraic(uint rung, Query query, Numbers numbers) {
    Algebraic a = algebraic_from(numbers, query.first);
    AlgebraicHits hits;
#ifdef EXACT
    if (rung == ALGEBRAIC_TWO_FLOAT) {
        algebraic_two_float(a, query.origin, query.direction, query.tmin, query.tmax, hits);
        return algebraic_answer(a, query, hits);
    }
#endif
    if (rung == ALGEBRAIC_FERRARI) {
        hits = algebraic_ferrari(a, query.origin, query.direction, query.tmin, query.tmax);
    } else if (rung == ALGEBRAIC_POLISHED) {
        hits = algebraic_polished(a, query.origin, query.direction, query.tmin, query.tmax);
    } else {
        hits = algebraic_bracketed(a, query.origin, query.direction, query.tmin, query.tmax);
    }
    return algebraic_answer(a, query, hits);
}
