// The views of a walk: the edges of boxes, over the picture.
#include "common/heat.glsl"

const float EDGE = 0.0035;    // half a line's width, at a distance of 1

// True if a point of a box's surface lies on an edge: then two of its three coordinates are those of walls.
bool is_on_edge(vec3 point, vec3 low, vec3 high, float width) {
    vec3 inset = min(point - low, high - point);
    vec3 close = vec3(lessThan(inset, vec3(width)));
    return close.x + close.y + close.z >= 2.0;
}

// The nearest edge of a box on this pixel's ray, where it comes before `t`.
bool draws_edge(vec3 o, vec3 d, Child child, inout float t) {
    const float LARGEST = 1e38;
    vec3 inverse = clamp(1.0 / d, -LARGEST, LARGEST);
    vec3 a = (child.low - o) * inverse;
    vec3 b = (child.high - o) * inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    vec2 span = vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
    for (int i = 0; i < 2; i++) {
        float width = EDGE * span[i] * length(d);
        if (span.x <= span.y && span[i] > 0.0 && span[i] < t
                && is_on_edge(o + span[i] * d, child.low, child.high, width)) {
            t = span[i];
            return true;
        }
    }
    return false;
}

// The number of nodes above a triangle in the tree of its mesh. A walk for a point: it enters all boxes that
// hold the triangle's first corner.
uint depth_of(Trees trees, Met met) {
    vec3 point = trees.corners.at[met.position].a;
    uint nodes[STACK];
    uint depths[STACK];
    nodes[0] = trees.placed.at[met.placed].root;
    depths[0] = 1;
    uint height = 1;
    while (height > 0) {
        height--;
        Node node = trees.nodes.at[nodes[height]];
        uint depth = depths[height];
        for (uint i = 0; i < 2; i++) {
            Child child = node.children[i];
            if (child.low != min(child.low, point) || child.high != max(child.high, point)) {
                continue;
            }
            if (child.count == 0) {
                nodes[height] = child.first;
                depths[height++] = depth + 1;
            } else if (met.position - child.first < child.count) {
                return depth;
            }
        }
    }
    return 0;
}

// This pixel's ray, and the nearest edge that it has met.
vec3 pixel_direction;
float edge_t = 1e30;
vec3 edge_color;
uint visited = 0;
uint last;    // the number of the last node that the view of one walk shows

// Called by the walk at each node. The rays of boxes are those of the pixels; in the view of one walk all
// pixels follow the one ray, and each looks at the boxes that it passes.
void visit(Trees trees, Node node, uint inside) {
    if (SHOW != SHOW_BOXES && SHOW != SHOW_WALK) {
        return;
    }
    visited++;
    if (SHOW == SHOW_WALK && visited > last) {
        return;
    }
    vec3 o = push.camera.origin;
    vec3 d = pixel_direction;
    if (inside != NOTHING) {
        Placed placed = trees.placed.at[inside];
        o = placed.to_object * vec4(o, 1.0);
        d = mat3(placed.to_object) * d;
    }
    for (uint i = 0; i < 2; i++) {
        Child child = node.children[i];
        vec3 side = child.high - child.low;
        float longest = max(max(side.x, side.y), side.z) / length(d);
        bool fits = longest > push.view.size && longest <= 2.0 * push.view.size;
        if (child.low.x > child.high.x || !(SHOW == SHOW_WALK || fits)) {
            continue;
        }
        // Of the present step white and over all others, of earlier ones by their number.
        bool present = SHOW == SHOW_WALK && visited == last;
        float t = present ? 1e30 : edge_t;
        if (draws_edge(o, d, child, t)) {
            edge_t = t;
            edge_color = present ? vec3(1.0)
                : SHOW == SHOW_WALK ? heat(0.1 + 0.7 * float(visited) / float(last))
                : false_color(child.first);
        }
    }
}

// The edges that were met, over a colour at distance t (-1 for none).
vec3 edges_over(vec3 color, float t) {
    float visible = t < 0.0 || edge_t < t * 1.001 ? 1.0 : 0.25;
    return edge_t < 1e30 ? mix(color, edge_color, visible) : color;
}
