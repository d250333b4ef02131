#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "bounds.glsl"
#include "node.glsl"
#include "index.glsl"

// The boxes of each node's children. A child is a range of positions, and a few boxes of the pyramid cover it: so no
// node waits for another, as it would if boxes were handed up the tree by who comes last (Karras 2012, section 4).

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Ends { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Nodes { Node at[]; };

layout(push_constant, scalar) uniform Fit {
    Nodes nodes;
    Ends ends;      // the other end of each node's range; of a node that is none, NO_NODE
    Boxes boxes;    // the pyramid, its lowest level first
    uint nodes_count;
    uint count;     // of boxes in the lowest level
} push;

const uint NO_NODE = 0xffffffff;

// The box around the positions from `first` up to `end`, that one left out. Where a pair is not whole in the range, its
// half is taken from this level; the rest is left to the level above.
Bounds box_around(uint first, uint end) {
    Bounds box = nowhere();
    uint level = 0, count = push.count;
    while (first < end) {
        if ((first & 1) != 0) {
            box = around(box, push.boxes.at[level + first++]);
        }
        if ((end & 1) != 0) {
            box = around(box, push.boxes.at[level + --end]);
        }
        first /= 2;
        end /= 2;
        level += count;
        count = (count + 1) / 2;
    }
    return box;
}

void set_box(uint node, uint child, Bounds box) {
    bool is_empty = !is_somewhere(box);
    push.nodes.at[node].children[child].low = is_empty ? no_child().low : box.low;
    push.nodes.at[node].children[child].high = is_empty ? no_child().high : box.high;
}

void main() {
    uint i = invocation();
    if (i >= push.nodes_count || push.ends.at[i] == NO_NODE) {
        return;
    }
    uint end = push.ends.at[i];
    uint middle = push.nodes.at[i].children[0].first + 1;
    set_box(i, 0, box_around(min(i, end), middle));
    set_box(i, 1, box_around(middle, max(i, end) + 1));
}
