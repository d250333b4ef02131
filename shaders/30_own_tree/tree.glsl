// Trees as a walk reads them: nodes, triangles and instances, all by address.
#include "node.glsl"

// The same node in 36 bytes: its boxes stand on a grid of its own, whose steps are powers of two. So a product
// with a step is exact, and the host has chosen places whose sums do not cut into the box.
struct Quantised {
    vec3 origin;
    uint steps;           // the exponents of x, y, z; and four bits a child, how many primitives it holds
    uint boxes[3];        // an axis: low of both children, high of both, a byte each
    uint first[2];
};

vec3 corner_of(Quantised node, vec3 steps, uint shift) {
    return node.origin + steps * vec3(
        node.boxes[0] >> shift & 0xff, node.boxes[1] >> shift & 0xff, node.boxes[2] >> shift & 0xff);
}

Node unpacked(Quantised node) {
    uvec3 exponents = uvec3(node.steps, node.steps >> 8, node.steps >> 16) & 0xffu;
    vec3 steps = uintBitsToFloat(exponents << 23);
    Node full;
    for (uint i = 0; i < 2; i++) {
        // Nothing has a low byte above the high one. Its box would not stay inside out when boxes grow.
        bool nothing = (node.boxes[0] >> 8 * i & 0xff) > (node.boxes[0] >> (16 + 8 * i) & 0xff);
        full.children[i] = nothing ? no_child() : Child(corner_of(node, steps, 8 * i), node.first[i],
            corner_of(node, steps, 16 + 8 * i), node.steps >> (24 + 4 * i) & 0xf);
    }
    return full;
}

// An instance: a leaf of the top tree leads to it, and it leads to the tree of its mesh.
struct Placed {
    mat4x3 to_world;
    mat4x3 to_object;
    uint root;            // of its mesh's tree
    uint first;           // where the corners of its mesh begin
    uint count;           // and how many triangles there are
    uint number;          // which instance of the scene
    float reach;          // the largest coordinate of its mesh, without its sign
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Nodes { Node at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Packed { Quantised at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer AllCorners { Corners at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer AllPlaced { Placed at[]; };

#ifdef INT64
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

// The 64 bytes of a node as eight words. llvmpipe fetches a structure number by number, each for all its rays
// together, and a number of 64 bits takes it no longer than one of 32.
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer NodeWords { uint64_t at[][8]; };

// The child whose four words begin at `at`: low.x and low.y, low.z and first, high.x and high.y, high.z and count.
Child child_of(uint64_t words[8], uint at) {
    uvec2 a = unpackUint2x32(words[at]), b = unpackUint2x32(words[at + 1]);
    uvec2 c = unpackUint2x32(words[at + 2]), d = unpackUint2x32(words[at + 3]);
    return Child(uintBitsToFloat(uvec3(a, b.x)), b.y, uintBitsToFloat(uvec3(c, d.x)), d.y);
}

Node node_at(Nodes nodes, uint index) {
    uint64_t words[8] = NodeWords(nodes).at[index];
    return Node(Child[2](child_of(words, 0), child_of(words, 4)));
}
#else
Node node_at(Nodes nodes, uint index) {
    return nodes.at[index];
}
#endif

// Everything that a walk reads. The root of the top tree is node 0.
struct Trees {
    Nodes nodes;
    Packed packed;        // the same nodes, quantised
    AllCorners corners;
    AllPlaced placed;
    float growth;         // by how much the boxes of the top tree grow, for a coordinate of 1
    float reach;          // the largest coordinate of the world, without its sign
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer AllTrees { Trees at[]; };
