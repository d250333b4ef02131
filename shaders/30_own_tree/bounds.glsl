// A box that grows.

struct Bounds {
    vec3 low;
    vec3 high;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Boxes { Bounds at[]; };

// A box that no ray meets, and that adds nothing to another. Without infinities: a compiler may take it that there are
// none, and what min() makes of one is then left open.
Bounds nowhere() {
    const float MOST = uintBitsToFloat(0x7f7fffffu);
    return Bounds(vec3(MOST), vec3(-MOST));
}

bool is_somewhere(Bounds box) {
    return box.low.x <= box.high.x;
}

Bounds around(Bounds a, Bounds b) {
    return Bounds(min(a.low, b.low), max(a.high, b.high));
}
