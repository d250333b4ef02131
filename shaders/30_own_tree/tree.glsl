// A tree of boxes as the shaders read it, and what its leaves hold.

// ANCHOR: node
// A box, and what lies in it: the node `first`, or `count` primitives from the position `first` on.
struct Child {
    vec3 low;
    uint first;
    vec3 high;
    uint count;           // 0 for a node
};

struct Node {
    Child children[2];
};                        // 64 bytes
// ANCHOR_END: node

// The corners of a triangle, in the order of the tree: the triangles of a leaf lie side by side.
struct Corners {
    vec3 a;
    vec3 b;
    vec3 c;
};

// ANCHOR: placed
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
// ANCHOR_END: placed

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Nodes { Node at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer AllCorners { Corners at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer AllPlaced { Placed at[]; };

// Everything that a walk reads. The root of the top tree is node 0.
struct Trees {
    Nodes nodes;
    AllCorners corners;
    AllPlaced placed;
    float growth;         // by how much the boxes of the top tree grow, for a coordinate of 1
    float reach;          // the largest coordinate of the world, without its sign
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer AllTrees { Trees at[]; };
