// A ray against a voxel: its low corner, its high one, and the values at its eight corners, x first.
#include "answer.glsl"
#include "voxel.glsl"
#include "voxel_two_float.glsl"

Voxel voxel_from(Numbers numbers, uint first) {
    Voxel v;
    v.low = vector_at(numbers, first);
    v.high = vector_at(numbers, first + 3);
    for (uint n = 0; n < 8; n++) {
        v.corner[n] = numbers.at[first + 6 + n];
    }
    return v;
}

Answer voxel_answer(Voxel v, Query query, VoxelHits hits) {
    Answer answer = NO_HIT;
    if (hits.count > 0) {
        answer.hit = 1;
        answer.t = hits.t;
        answer.count = hits.count;
        answer.normal =
            unit(voxel_gradient(v, (query.origin + hits.t * query.direction - v.low) / (v.high - v.low)));
    }
    return answer;
}

Answer ask_voxel(uint rung, Query query, Numbers numbers) {
    Voxel v = voxel_from(numbers, query.first);
    VoxelHits hits;
#ifdef EXACT
    if (rung == VOXEL_TWO_FLOAT) {
        voxel_two_float(v, query.origin, query.direction, query.tmin, query.tmax, hits);
        return voxel_answer(v, query, hits);
    }
#endif
    if (rung == VOXEL_MARCH) {
        hits = voxel_march(v, query.origin, query.direction, query.tmin, query.tmax);
    } else if (rung == VOXEL_CARDANO) {
        hits = voxel_cardano(v, query.origin, query.direction, query.tmin, query.tmax);
    } else {
        hits = voxel_bracketed(v, query.origin, query.direction, query.tmin, query.tmax);
    }
    return voxel_answer(v, query, hits);
}
