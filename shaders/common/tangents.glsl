// Taught by 47_normal_maps.
//
// The normal that a texture writes down, in the frame of a triangle's texture coordinates.
#include "surface.glsl"

// The steepest slope, about 87 degrees: beyond, the mapped normal would point along the surface, or into it.
const float STEEPEST = 20.0;

// ANCHOR: texel
// The slope of a texel: x and y of its normal over z. The three are written as 0 to 1 for -1 to 1.
vec2 texel_slope(vec3 texel, float scale) {
    vec3 normal = 2.0 * texel - 1.0;
    // No byte means 0: it is between 127 and 128, and both are written for it.
    vec2 aside = mix(normal.xy, vec2(0.0), lessThan(abs(normal.xy), vec2(0.004))) * scale;
    // Also for a texel that is no normal, such as black.
    return aside / max(normal.z, max(length(aside) / STEEPEST, 1e-3));
}
// ANCHOR_END: texel

// ANCHOR: axes
// The directions on a triangle in which an image's rows run to the right and its columns up, across the normal and
// across each other; zero if the texture coordinates have no area. `sides` are two sides of the triangle in the
// world, and `steps` those of its texture coordinates; v grows downwards.
mat2x3 texture_axes(mat2x3 sides, mat2 steps, vec3 normal) {
    // Products of very small or very large numbers would vanish or overflow.
    float size = max(max(largest(abs(sides[0])), largest(abs(sides[1]))), 1e-37);
    vec3 first = sides[0] / size, second = sides[1] / size;
    vec2 widest = max(abs(steps[0]), abs(steps[1]));
    vec2 a = steps[0] / max(max(widest.x, widest.y), 1e-37);
    vec2 b = steps[1] / max(max(widest.x, widest.y), 1e-37);
    float turn = sign(a.x * b.y - a.y * b.x);
    vec3 right = turn * (b.y * first - a.y * second);
    vec3 up = turn * (b.x * first - a.x * second);
    right -= dot(right, normal) * normal;
    float square = dot(right, right);
    if (!(square > 1e-20)) {
        return mat2x3(0.0);
    }
    right *= inversesqrt(square);
    // On a mirrored part of the texture, up is on the other side of right.
    vec3 across = cross(normal, right);
    return mat2x3(right, dot(across, up) < 0.0 ? -across : across);
}
// ANCHOR_END: axes
