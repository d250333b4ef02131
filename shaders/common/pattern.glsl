// Taught by 13_callable_shader.
//
// Patterns that fill space, made of an integer lattice: marble, wood, a checker board.
//
// A place is in cells of the lattice. Its whole part is an integer, so the hash that it is the key of is the
// same on every device; `far` moves it by whole cells along x, and no digit of its fraction is lost.
#include "common/random.glsl"

struct Pattern {
    vec3 place;
    int far;
    float weight;    // of the second of two colours, 0 to 1
};

const uint PATTERN_PLAIN = 0;
const uint PATTERN_MARBLE = 1;
const uint PATTERN_WOOD = 2;
const uint PATTERN_CHECKER = 3;

// ANCHOR: noise
float lattice(ivec3 cell) {
    return to_unit(hash(uvec4(uvec3(cell), 0)).x);
}

// Clamps to where cells have numbers: a float beyond 2^31 does not fit into an int.
vec3 within(vec3 place) {
    return clamp(place, -1e9, 1e9);
}

float between(float a, float b, float t) {
    return a + t * (b - a);
}

// A smooth number from 0 to 1: the corners of a cell have random ones (value noise; Perlin, "An Image
// Synthesizer", SIGGRAPH 1985, without the gradients).
float noise(vec3 place, int far) {
    place = within(place);
    vec3 corner = floor(place);
    vec3 t = place - corner;          // 0 to 1; 1 is the next cell's 0, and just below 0 it may be rounded to 1
    t = t * t * (3.0 - 2.0 * t);
    ivec3 cell = ivec3(corner) + ivec3(far, 0, 0);
    float edges[4];
    for (int k = 0; k < 4; k++) {
        ivec3 at = cell + ivec3(0, k & 1, k >> 1);
        edges[k] = between(lattice(at), lattice(at + ivec3(1, 0, 0)), t.x);
    }
    return between(between(edges[0], edges[1], t.y), between(edges[2], edges[3], t.y), t.z);
}

// Four octaves of it: each has twice the frequency and half the strength of the one before.
float turbulence(vec3 place, int far) {
    float sum = 0.0;
    float strength = 0.5;
    for (int octave = 0; octave < 4; octave++) {
        sum += strength * noise(place, far);
        place *= 2.0;
        far *= 2;
        strength *= 0.5;
    }
    return sum;
}

// 1 at whole numbers, 0 half-way between them. Not by fract(), which some devices keep below 1.
float ridge(float x) {
    return abs(2.0 * (x - floor(x)) - 1.0);
}
// ANCHOR_END: noise

// ANCHOR: patterns
// Veins where a ridge is folded by turbulence. A ridge repeats with every whole number: `far` leaves it alone.
float marble(vec3 place, int far) {
    float vein = ridge(place.x + 0.5 * place.y + 2.5 * turbulence(place, far));
    return vein * vein * vein;
}

// Grain along y: slow noise cut into layers, and fibres.
float wood(vec3 place, int far) {
    float layer = ridge(5.0 * noise(vec3(place.x, 0.125 * place.y, place.z), far));
    float fibre = noise(vec3(16.0 * place.x, place.y, 16.0 * place.z), 16 * far);
    return 0.75 * layer + 0.25 * fibre;
}

// Every other cell.
float checker(vec3 place, int far) {
    ivec3 cell = ivec3(floor(within(place)));
    return float((cell.x + far + cell.y + cell.z) & 1);
}
// ANCHOR_END: patterns
