// A tree of boxes, as samples/30_own_tree/tree.rs has it.

// ANCHOR: node
// A box and its contents: a node, or some primitives.
struct Child {
    vec3 low;
    uint first;    // a node's index if count is 0, else the first primitive's position in the tree's order
    vec3 high;
    uint count;    // of primitives; 0 for a node
};

struct Node {
    Child children[2];
};
// ANCHOR_END: node

// The corners of a triangle, in a row: the triangles of a leaf lie side by side.
struct Corners {
    vec3 a;
    vec3 b;
    vec3 c;
};

const uint NOTHING = 0xffffffff;

// Nothing, in a box that no ray meets: inside out by so much that growing does not turn it, and by so little that
// all numbers of a walk stay finite. Vulkan leaves open how others compare.
Child no_child() {
    return Child(vec3(1e10), NOTHING, vec3(-1e10), 0);
}
