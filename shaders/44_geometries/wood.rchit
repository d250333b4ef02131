#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "look.glsl"
#include "common/noise.glsl"

// Wood: the rings of a trunk, cut by the surface. Each square of the board is cut from its own.
void main() {
    vec3 normal = world_normal(surface_at_hit());
    vec3 p = object_position();
    // Inside the frame lie squares of one unit; the frame is four boards, mitred at the corners.
    bool frame = max(abs(p.x), abs(p.z)) > 4.0;
    ivec3 block = frame ? ivec3(0) : ivec3(floor(p.x), 1, floor(p.z));
    bool along_x = !frame || abs(p.z) > abs(p.x);
    uvec4 bits = hash(uvec4(uvec3(block), look.record));
    vec3 q = along_x ? p.yzx : p.yxz;
    // The middle of the trunk lies along z, somewhere off the block.
    vec2 middle = vec2(2.0 + 2.0 * to_unit(bits.x), 4.0 * to_unit(bits.y) - 2.0);
    float width = look.scale * pixel_width(normal);
    q = look.scale * (q + vec3(middle, 20.0 * to_unit(bits.z)));
    float radius = length(q.xy) + 0.12 * fractal_noise(q * vec3(1.0, 1.0, 0.25), look.record, width);
    float year = 9.0 * radius;
    // Early wood is pale and slowly darkens; a new year begins at once.
    float age = fract(year);
    float ring = age * age * (1.0 - smoothstep(0.85, 1.0, age));
    ring = mix(0.265, ring, detail(1.0, 9.0 * width));
    float fibres = noise(q * vec3(70.0, 70.0, 2.0), look.record) * detail(1.0, 70.0 * width);
    vec3 base = look.tint * (1.1 - 0.4 * ring + 0.25 * fibres);
    payload = answer(GROUP_WOOD, polished(base, normal));
}
