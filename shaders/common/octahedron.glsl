// Taught by 31_history_and_filter.
//
// Unit vectors in 32 bits.

// The distance between a unit normal and its unpacked form is smaller. 16 bits are off by 2^-16 in each of two
// coordinates. The third moves with both, which makes it sqrt(6) times as much, and normalising stretches that by up
// to sqrt(3): 6.5e-5.
const float PACKING = 7e-5;

// A unit vector as a point of an octahedron, unfolded to a square (Meyer and others, "On Floating-Point
// Normal Vectors", 2010).
uint packed(vec3 normal) {
    vec2 at = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    vec2 folded = (1.0 - abs(at.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(at, vec2(0.0)));
    ivec2 parts = ivec2(round(32767.0 * clamp(normal.z < 0.0 ? folded : at, -1.0, 1.0)));
    return uint(parts.x) & 0xffffu | uint(parts.y) << 16;
}

vec3 unpacked(uint normal) {
    vec2 at = vec2(int(normal << 16) >> 16, int(normal) >> 16) / 32767.0;
    vec3 on = vec3(at, 1.0 - abs(at.x) - abs(at.y));
    float below = max(-on.z, 0.0);
    on.xy -= below * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(on.xy, vec2(0.0)));
    return normalize(on);
}
