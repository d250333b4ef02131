#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "look.glsl"
#include "common/noise.glsl"

// White marble: veins where noise passes zero, in clouds of grey.
void main() {
    vec3 normal = world_normal(surface_at_hit());
    // ANCHOR: veins
    vec3 p = look.scale * object_position();
    float width = look.scale * pixel_width(normal);
    uint seed = 64 * look.record;
    // ANCHOR_END: veins
    // Bent by noise, or else the veins would be smooth.
    vec3 bend = vec3(fractal_noise(2.0 * p, seed, 2.0 * width),
                     fractal_noise(2.0 * p, seed + 8, 2.0 * width),
                     fractal_noise(2.0 * p, seed + 16, 2.0 * width));
    vec3 q = p + 0.35 * bend;
    float clouds = 0.5 + 0.5 * fractal_noise(1.5 * q, seed + 24, width);
    float vein = abs(noise(1.7 * q, seed + 32));
    // A vein thinner than a pixel is drawn as wide as the pixel, and paler by as much.
    float thin = 0.06;
    float drawn = max(thin, 2.0 * width);
    float line = thin / drawn * (1.0 - smoothstep(0.0, drawn, vein));
    float halo = 1.0 - smoothstep(0.0, 0.3, vein);
    vec3 base = look.tint * mix(vec3(1.0), vec3(0.62, 0.6, 0.58), clouds * (0.3 + 0.4 * halo));
    base = mix(base, look.tint * vec3(0.33, 0.3, 0.28), 0.6 * line);
    payload = answer(GROUP_MARBLE, polished(base, normal));
}
