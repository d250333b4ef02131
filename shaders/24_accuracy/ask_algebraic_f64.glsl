// A ray against an algebraic surface in 64 bits. After ask_algebraic.glsl.
#include "algebraic_f64.glsl"

Answer ask_algebraic_f64(Query query, Numbers numbers) {
    Algebraic a = algebraic_from(numbers, query.first);
    AlgebraicHits hits;
    algebraic_float64(a, query.origin, query.direction, query.tmin, query.tmax, hits);
    return algebraic_answer(a, query, hits);
}
