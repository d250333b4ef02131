// Lookup of a triangle's opacity before any texture is read.

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer States { uint at[]; };

struct Micromap {
    States states;       // 16 a word, triangle after triangle in the model's order
    int level;           // -1 where there are none
    uint padding;
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Micromaps { Micromap at[]; };

// The specification's numbers.
const uint STATE_TRANSPARENT = 0;
const uint STATE_OPAQUE = 1;
const uint STATE_UNKNOWN_TRANSPARENT = 2;
const uint STATE_UNKNOWN_OPAQUE = 3;

// The distance outside a triangle at which a hit may still be looked up. The bound on each state covers it.
const float SLACK = 1.0 / 16384.0;

// The number of the micro-triangle that contains a point. `w` are the weights of the three corners. Each turn finds
// the part that contains the point, and the point's weights in it. For any weights, the number is below 4^level.
uint micro_triangle(vec3 w, int level) {
    uint index = 0;
    for (int i = 0; i < level; i++) {
        uint part = 1;
        if (w.x >= 0.5) {
            part = 0;
            w = vec3(2.0 * w.x - 1.0, 2.0 * w.y, 2.0 * w.z);
        } else if (w.y >= 0.5) {
            part = 2;
            w = vec3(2.0 * w.x, 2.0 * w.y - 1.0, 2.0 * w.z);
        } else if (w.z >= 0.5) {
            part = 3;
            w = vec3(2.0 * w.y, 2.0 * w.x, 2.0 * w.z - 1.0);
        } else {
            w = 1.0 - 2.0 * w.yxz;
        }
        index = 4 * index + part;
    }
    return index;
}

// The state of a hit; `barycentrics` are its hit attributes.
uint state_at(Micromap micromap, uint triangle, vec2 barycentrics) {
    vec3 w = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    // A weight that is not a number fails here, too.
    bool inside = w.x >= -SLACK && w.y >= -SLACK && w.z >= -SLACK;
    if (micromap.level < 0 || !inside) {
        return STATE_UNKNOWN_OPAQUE;
    }
    // Two bits per state, and at least a byte per triangle.
    uint first = triangle * max(2u << (2 * micromap.level), 8u);
    uint bit = first + 2 * micro_triangle(w, micromap.level);
    return micromap.states.at[bit >> 5] >> (bit & 31u) & 3u;
}

// Wood, sky, and what has to be looked up: bright where a guess takes it for opaque.
vec3 color_of(uint state) {
    switch (state) {
        case STATE_OPAQUE: return vec3(0.21, 0.08, 0.02);
        case STATE_TRANSPARENT: return vec3(0.3, 0.6, 0.9);
        case STATE_UNKNOWN_OPAQUE: return vec3(1.0, 0.7, 0.05);
        default: return vec3(0.75, 0.3, 0.0);
    }
}
