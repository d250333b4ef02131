// The corners of a triangle of a mesh, and the box around them.
#include "common/scene.glsl"
#include "bounds.glsl"
#include "node.glsl"

Corners corners_of(Vertices vertices, uvec3 triangle) {
    return Corners(
        vertices.at[triangle.x].position,
        vertices.at[triangle.y].position,
        vertices.at[triangle.z].position
    );
}

// Neither infinite nor no number. By the bits: a compiler may take it that floats are finite.
bool is_finite(vec3 v) {
    const uint EXPONENT = 0x7f800000u;
    return all(notEqual(floatBitsToUint(v) & EXPONENT, uvec3(EXPONENT)));
}

// The least box around a triangle. A triangle that is not finite has none, so that no ray meets it.
Bounds box_of(Corners t) {
    if (!(is_finite(t.a) && is_finite(t.b) && is_finite(t.c))) {
        return nowhere();
    }
    return Bounds(min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c));
}

// Halved before they are added: the sum of two finite corners may not be finite.
vec3 centre(Bounds box) {
    return 0.5 * box.low + 0.5 * box.high;
}
