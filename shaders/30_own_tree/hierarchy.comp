#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "node.glsl"
#include "extent.glsl"
#include "index.glsl"

// The parent of every node, from sorted keys, for all nodes at once (Karras, "Maximizing Parallelism in the
// Construction of BVHs, Octrees, and k-d Trees", High Performance Graphics 2012, section 4).

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Keys { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Ends { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer Nodes { Node at[]; };

layout(push_constant, scalar) uniform Hierarchy {
    Keys keys;
    Extents extents;
    Nodes nodes;
    Ends ends;      // the other end of each node's range; of a node that is none, NO_NODE
    uint nodes_count;
} push;

const uint NO_NODE = 0xffffffff;

// The number of leading bits that the keys at two positions share; less than any if there is no such position. Equal
// keys are compared by their positions, so that no two are the same.
int shared_prefix(uint key, int i, int j, int count) {
    if (j < 0 || j >= count) {
        return -1;
    }
    uint differ = key ^ push.keys.at[j];
    return differ != 0 ? 31 - findMSB(differ) : 63 - findMSB(i ^ j);
}

// A node's range begins or ends at the node's own index. It grows to the side where the keys are more alike, as far as
// they share more bits with the node's key than its neighbour on the other side does, which is outside.
int other_end(uint key, int i, int side, int outside, int count) {
    int most = 2;
    while (shared_prefix(key, i, i + most * side, count) > outside) {
        most *= 2;
    }
    int reach = 0;
    for (int more = most / 2; more > 0; more /= 2) {
        if (shared_prefix(key, i, i + (reach + more) * side, count) > outside) {
            reach += more;
        }
    }
    return i + reach * side;
}

// The last position of the range's left part: there the keys' first bit that they do not all share changes.
int split(uint key, int i, int side, int end, int count) {
    int inside = shared_prefix(key, i, end, count);
    int length = abs(end - i), reach = 0, more = length;
    do {
        more = (more + 1) / 2;
        if (shared_prefix(key, i, i + (reach + more) * side, count) > inside) {
            reach += more;
        }
    } while (more > 1);
    return i + reach * side + min(side, 0);
}

// Without a box, until its primitives' boxes are known.
Child child(int first, bool is_leaf) {
    Child none = no_child();
    return Child(none.low, first, none.high, is_leaf ? 1 : 0);
}

void main() {
    int i = int(invocation());
    if (i >= push.nodes_count) {
        return;
    }
    int count = int(push.extents.at[0].count);
    if (i + 1 >= count) {
        // Of one primitive alone there is a node with one child; others that are not finite have none.
        bool is_only = i == 0 && count == 1;
        push.nodes.at[i].children = Child[2](is_only ? child(0, true) : no_child(), no_child());
        push.ends.at[i] = is_only ? 0 : NO_NODE;
        return;
    }
    uint key = push.keys.at[i];
    int before = shared_prefix(key, i, i - 1, count), after = shared_prefix(key, i, i + 1, count);
    int side = after > before ? 1 : -1;
    int end = other_end(key, i, side, min(before, after), count);
    int middle = split(key, i, side, end, count);
    push.nodes.at[i].children = Child[2](
        child(middle, middle == min(i, end)),
        child(middle + 1, middle + 1 == max(i, end))
    );
    push.ends.at[i] = end;
}
