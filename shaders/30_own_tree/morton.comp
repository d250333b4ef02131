#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "corners.glsl"
#include "extent.glsl"
#include "index.glsl"

// A key for each triangle, such that neighbours in the order of the keys are mostly neighbours in space: the Morton
// code of its centre (Morton 1966), the bits of three coordinates in turns.

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Words { uint at[]; };

layout(push_constant, scalar) uniform Code {
    Vertices vertices;
    Triangles triangles;
    Extents extents;
    Words keys;
    Words values;    // which triangle has the key
    uint count;
} push;

// Sorts behind every finite triangle.
const uint NOT_FINITE = 0x3fffffff;

// Puts two zeros between each two of ten bits.
uint spread(uint bits) {
    bits = (bits | bits << 16) & 0x030000ff;
    bits = (bits | bits << 8) & 0x0300f00f;
    bits = (bits | bits << 4) & 0x030c30c3;
    return (bits | bits << 2) & 0x09249249;
}

// The cells are cubes: were they as flat as the whole, boxes would be longer. All is halved before it is subtracted:
// the difference of two finite numbers may not be finite.
uint morton(vec3 centre, Extent all) {
    vec3 sides = 0.5 * all.high - 0.5 * all.low;
    float side = max(max(sides.x, sides.y), sides.z);
    vec3 part = (0.5 * centre - 0.5 * all.low) / (side > 0.0 ? side : 1.0);
    // A point on the far side belongs to the last of 1024 cells.
    uvec3 cell = min(uvec3(1024.0 * part), uvec3(1023));
    return min(spread(cell.x) << 2 | spread(cell.y) << 1 | spread(cell.z), NOT_FINITE - 1);
}

void main() {
    uint i = invocation();
    if (i >= push.count) {
        return;
    }
    Bounds box = box_of(corners_of(push.vertices, push.triangles.at[i]));
    push.keys.at[i] = is_somewhere(box) ? morton(centre(box), push.extents.at[0]) : NOT_FINITE;
    push.values.at[i] = i;
}
