#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "corners.glsl"
#include "index.glsl"

// The corners of the triangle at each position, and the box around it.

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Ordered { Corners at[]; };

layout(push_constant, scalar) uniform Leaves {
    Vertices vertices;
    Triangles triangles;
    Original original;
    Ordered corners;
    Boxes boxes;
    uint count;
} push;

void main() {
    uint i = invocation();
    if (i >= push.count) {
        return;
    }
    Corners corners = corners_of(push.vertices, push.triangles.at[push.original.at[i]]);
    push.corners.at[i] = corners;
    push.boxes.at[i] = box_of(corners);
}
