// A ray against a bilinear patch: its corners at (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1).
#include "answer.glsl"
#include "patch.glsl"
#include "patch_two_float.glsl"

Patch patch_at(Numbers numbers, uint first) {
    return Patch(vector_at(numbers, first), vector_at(numbers, first + 3), vector_at(numbers, first + 6),
        vector_at(numbers, first + 9));
}

Answer ask_patch(uint rung, Query query, Numbers numbers) {
    Patch quad = patch_at(numbers, query.first);
    Answer answer = NO_HIT;
    PatchHits hits;
#ifdef EXACT
    if (rung == PATCH_TWO_FLOAT) {
        patch_two_float(quad, query.origin, query.direction, query.tmin, query.tmax, hits, answer.normal);
        answer.hit = hits.count > 0 ? 1 : 0;
        answer.t = hits.t;
        answer.count = hits.count;
        return answer;
    }
#endif
    hits = rung == PATCH_TEXTBOOK ? patch_textbook(quad, query.origin, query.direction, query.tmin, query.tmax)
                                  : patch_stable(quad, query.origin, query.direction, query.tmin, query.tmax);
    if (hits.count > 0) {
        answer.hit = 1;
        answer.t = hits.t;
        answer.count = hits.count;
        answer.normal = unit(patch_normal(quad, hits.uv));
    }
    return answer;
}
