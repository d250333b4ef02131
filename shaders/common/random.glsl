// Taught by 03_any_hit.
//
// Random numbers without state: the same key gives the same number, in every shader and at every time.

// A hash of four numbers to four (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg4d).
// One component after the other: each takes what the ones before it have become.
uvec4 hash(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w; v.y += v.z * v.x; v.z += v.x * v.y; v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w; v.y += v.z * v.x; v.z += v.x * v.y; v.w += v.y * v.z;
    return v;
}

// The upper 24 bits as a number in [0, 1): every one of them is exact in 32-bit floats.
float to_unit(uint bits) {
    return float(bits >> 8u) * (1.0 / 16777216.0);
}

// ANCHOR: random
// The purpose of a number. Each has numbers of its own, so that dropping one shifts no other.
const uint DIMENSION_LIGHT = 0;
const uint DIMENSION_PIXEL = 1;

// Four numbers in [0, 1) that belong to a pixel, one of its samples, a bounce and a purpose.
vec4 random(uvec2 pixel, uint sample_index, uint bounce, uint dimension) {
    uvec4 bits = hash(uvec4(pixel.x | pixel.y << 16u, sample_index, bounce, dimension));
    return vec4(to_unit(bits.x), to_unit(bits.y), to_unit(bits.z), to_unit(bits.w));
}
// ANCHOR_END: random
