// Taught by 11_path_tracing.
//
// The random numbers of a path: two for each purpose at each bounce, that belong to the pixel and to one of its
// samples.
#include "common/sobol.glsl"

// The purposes of numbers that earlier chapters do not have.
const uint DIMENSION_CHOICE = 2;
const uint DIMENSION_BOUNCE = 3;
const uint DIMENSION_ROULETTE = 4;

// Each pair is a point of the unit square of its own, two dimensions of the many that a path has.
vec2 numbers(uvec2 pixel, uint sample_index, uint bounce, uint dimension, uint seed) {
    uvec4 key = hash(uvec4(pixel.x | pixel.y << 16u, bounce, dimension, seed));
    // Without an order of its own, a pair would repeat what the other pairs of this sample do.
    uvec2 point = sobol(owen(sample_index, key.z));
    return vec2(to_unit(owen(point.x, key.x)), to_unit(owen(point.y, key.y)));
}
