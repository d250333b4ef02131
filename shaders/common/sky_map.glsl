// Taught by 46_environment.
//
// The picture of the sky: the light of a direction, and directions chosen by their light.
//
// Row 0 is up, and the middle column looks along -z, with x at its right.
#include "sky.glsl"
#include "solid_angle.glsl"

const float TURN = 6.283185307;

// ANCHOR: lookup
// The nearest texel, not a mean of four: the light must be constant in a texel, as the density is.
Texel texel_at(SkyAddresses sky, float rotation, vec3 direction) {
    float around = angle_between(-direction.z, abs(direction.x)) / TURN;
    float u = fract(0.5 + (direction.x < 0.0 ? -around : around) + rotation);
    float v = angle_between(direction.y, length(direction.xz)) / (0.5 * TURN);
    uvec2 at = min(uvec2(vec2(u, v) * vec2(sky.size)), sky.size - 1);
    return sky.texels.at[at.y * sky.size.x + at.x];
}
// ANCHOR_END: lookup

// ANCHOR: choose
// A texel, each as often as its share of the light; `u` are multiples of 2^-24, and there are 2^k columns.
uint chosen_texel(SkyAddresses sky, vec2 u) {
    uint column = uint(u.x * float(sky.column_count));
    Column found = sky.columns.at[column];
    return u.y < found.own ? column : found.other;
}

// A direction in a texel, uniform in its solid angle: even around, and even in height.
vec3 direction_in(SkyAddresses sky, float rotation, uint texel, vec2 u) {
    uvec2 at = uvec2(texel % sky.size.x, texel / sky.size.x);
    SkyRow row = sky.rows.at[at.y];
    float y = row.top - u.y * row.height;
    float radius = sqrt(max((1.0 - y) * (1.0 + y), 0.0));
    // From -pi to pi: Vulkan bounds a sine's error only there.
    float angle = 6.283185 * (fract((float(at.x) + u.x) / float(sky.size.x) - rotation) - 0.5);
    return normalize(vec3(radius * sin(angle), y, -radius * cos(angle)));
}
// ANCHOR_END: choose

struct SkySample {
    vec3 direction;
    vec3 radiance;
    float density;    // in solid angle; 0 if there is no light
};

// ANCHOR: sample
// A direction for a shadow ray.
SkySample sky_sample(SkyAddresses sky, float rotation, vec2 u, vec2 within) {
    if (SAMPLER == SAMPLER_UNIFORM) {
        float y = 1.0 - 2.0 * within.y;
        float radius = sqrt(max((1.0 - y) * (1.0 + y), 0.0));
        float angle = 6.283185 * (within.x - 0.5);
        vec3 direction = normalize(vec3(radius * sin(angle), y, -radius * cos(angle)));
        return SkySample(direction, texel_at(sky, rotation, direction).radiance, 1.0 / (2.0 * TURN));
    }
    if (sky.column_count == 0) {
        return SkySample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0);
    }
    uint chosen = chosen_texel(sky, u);
    Texel texel = sky.texels.at[chosen];
    return SkySample(direction_in(sky, rotation, chosen, within), texel.radiance, texel.density);
}
// ANCHOR_END: sample
