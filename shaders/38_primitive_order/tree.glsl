// The tree that halves the list, walked for a count: what the device's own walk does cannot be asked.
#include "common/box.glsl"

// The number of boxes that a ray is tested against, up to `end`.
uint boxes_tested(vec3 o, vec3 d, float end) {
    uint tested = 0;
    uint i = 0;
    while (i < push.shapes.nodes) {
        Node node = push.shapes.tree.at[i];
        vec2 t;
        vec3 faces[2];
        bool met = box_division(o, d, node.low, node.high, t, faces) && t.y >= 0.0 && t.x <= end;
        tested++;
        i = met ? i + 1 : node.next;
    }
    return tested;
}

// From dark blue over red to yellow and white: each step of color is as many times as many tests.
vec4 view_of_tests(vec3 origin, vec3 direction, float end) {
    uint tested = boxes_tested(origin, direction, end);
    return vec4(heat(log2(float(tested)) / 14.0), tested);
}
