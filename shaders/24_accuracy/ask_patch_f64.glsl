// A ray against a bilinear patch in 64 bits. After ask_patch.glsl.
#include "patch_f64.glsl"

Answer ask_patch_f64(Query query, Numbers numbers) {
    Answer answer = NO_HIT;
    PatchHits hits;
    patch_float64(patch_at(numbers, query.first), query.origin, query.direction, query.tmin, query.tmax, hits, answer.normal);
    answer.hit = hits.count > 0 ? 1 : 0;
    answer.t = hits.t;
    answer.count = hits.count;
    return answer;
}
