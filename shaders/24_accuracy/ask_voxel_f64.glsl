// A ray against a voxel in 64 bits. After ask_voxel.glsl.
#include "voxel_f64.glsl"

Answer ask_voxel_f64(Query query, Numbers numbers) {
    Voxel v = voxel_from(numbers, query.first);
    VoxelHits hits;
    voxel_float64(v, query.origin, query.direction, query.tmin, query.tmax, hits);
    return voxel_answer(v, query, hits);
}
