// Taught by 07_multi_closest_hit.
//
// Textures from nothing: gradient noise on the lattice of whole numbers (Perlin 2002).
#include "common/random.glsl"

// A vector that belongs to a corner of the lattice, each part from -1 to 1.
vec3 gradient(ivec3 corner, uint seed) {
    uvec4 bits = hash(uvec4(uvec3(corner), seed));
    return 2.0 * vec3(to_unit(bits.x), to_unit(bits.y), to_unit(bits.z)) - 1.0;
}

// Smooth noise, about -1 to 1, that changes over a distance of 1.
float noise(vec3 p, uint seed) {
    ivec3 cell = ivec3(floor(p));
    vec3 f = fract(p);
    vec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    float corners[8];
    for (int i = 0; i < 8; i++) {
        ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        corners[i] = dot(gradient(cell + corner, seed), f - vec3(corner));
    }
    vec4 x = mix(
        vec4(corners[0], corners[2], corners[4], corners[6]),
        vec4(corners[1], corners[3], corners[5], corners[7]),
        w.x
    );
    vec2 y = mix(x.xz, x.yw, w.y);
    return mix(y.x, y.y, w.z);
}

// The visible fraction of a detail of this size: none if a pixel is wider than half of it.
float detail(float size, float width) {
    return 1.0 - smoothstep(0.25 * size, 0.5 * size, width);
}

// Noise of five sizes, each half as large and half as strong as the one before. What is finer than a
// pixel would only flicker, and is left out.
float fractal_noise(vec3 p, uint seed, float width) {
    float sum = 0.0;
    float strength = 1.0;
    for (uint octave = 0; octave < 5 && width < 0.5; octave++) {
        sum += strength * detail(1.0, width) * noise(p, seed + octave);
        // Shifted, so that the lattices do not share their corners, where the noise is 0.
        p = 2.0 * p + 0.37;
        width *= 2.0;
        strength *= 0.5;
    }
    return sum;
}
