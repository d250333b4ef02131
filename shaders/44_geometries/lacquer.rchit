#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "look.glsl"
#include "common/noise.glsl"

// Lacquer: a deep coat with gold dust in it.
void main() {
    vec3 normal = world_normal(surface_at_hit());
    vec3 p = object_position();
    vec3 q = 20.0 * look.scale * p;
    float width = 20.0 * look.scale * pixel_width(normal);
    // One flake in each cell of a lattice, of its own place, size and brightness; fewer further up.
    uvec4 bits = hash(uvec4(uvec3(ivec3(floor(q))), look.record));
    vec3 unit = vec3(to_unit(bits.x), to_unit(bits.y), to_unit(bits.z));
    float size = min(0.3, 0.5 * to_unit(bits.w) - 0.6 * p.y);
    float inside = size - distance(fract(q), 0.3 + 0.4 * unit);
    float flake = size > 0.0 ? clamp(0.5 + inside / min(width, size), 0.0, 1.0) : 0.0;
    // From afar what counts is how much of the lacquer is gold: 4/3 π times the mean of size³.
    float fade = max(1.0 - 1.2 * p.y, 0.0);
    flake = mix(0.06 * fade * fade * fade, flake, detail(1.0, width));
    vec3 base = mix(look.tint, vec3(0.83, 0.53, 0.16) * (0.3 + unit.x), flake);
    payload = answer(GROUP_LACQUER, polished(base, normal));
}
