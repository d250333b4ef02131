// Taught by 11_path_tracing.
//
// The random numbers of a path: two for each purpose at each bounce, that belong to the pixel and to one of its
// samples.
#include "common/sobol.glsl"

// The purposes of numbers that earlier chapters do not have.
const uint DIMENSION_CHOICE = 2;
const uint DIMENSION_BOUNCE = 3;
const uint DIMENSION_ROULETTE = 4;

// A point of the unit square: two of the many dimensions of a path.
vec2 numbers(uvec2 pixel, uint sample_index, uint bounce, uint dimension, uint seed) {
    uvec4 key = hash(uvec4(pixel.x | pixel.y << 16u, bounce, dimension, seed));
    // Each pair takes the points in its own order; otherwise the pairs of a sample would be tied together.
    uvec2 point = sobol(owen(sample_index, key.z));
    return vec2(to_unit(owen(point.x, key.x)), to_unit(owen(point.y, key.y)));
}
