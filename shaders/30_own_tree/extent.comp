#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "corners.glsl"
#include "extent.glsl"
#include "index.glsl"

// Where the centres of all triangles lie. In a first step each workgroup finds it out for its share; in a second
// one workgroup puts these together.

layout(push_constant, scalar) uniform Reduce {
    Vertices vertices;
    Triangles triangles;
    Extents extents;    // of all triangles, then of each share
    uint count;         // of triangles
    uint shares;        // how many workgroups the first step has
    uint is_last;       // 1 in the second step
} push;

shared Extent found[WIDTH];

Extent together(Extent a, Extent b) {
    return Extent(min(a.low, b.low), a.count + b.count, max(a.high, b.high));
}

void main() {
    const uint self = gl_LocalInvocationIndex;
    Extent own = Extent(nowhere().low, 0, nowhere().high);
    uint count = push.is_last == 0 ? push.count : 0;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += WIDTH * push.shares) {
        Bounds box = box_of(corners_of(push.vertices, push.triangles.at[i]));
        if (is_somewhere(box)) {
            own = together(own, Extent(centre(box), 1, centre(box)));
        }
    }
    uint shares = push.is_last == 0 ? 0 : push.shares;
    for (uint i = self; i < shares; i += WIDTH) {
        own = together(own, push.extents.at[1 + i]);
    }
    // Half of them take in what the others have found, then half of that half.
    found[self] = own;
    for (uint others = WIDTH / 2; others > 0; others /= 2) {
        barrier();
        if (self < others) {
            found[self] = together(found[self], found[self + others]);
        }
    }
    if (self == 0) {
        push.extents.at[push.is_last == 0 ? 1 + gl_WorkGroupID.x : 0] = found[0];
    }
}
