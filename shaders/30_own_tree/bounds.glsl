// A box that grows.

struct Bounds {
    vec3 low;
    vec3 high;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Boxes { Bounds at[]; };

// A box that no ray meets, and that adds nothing to another.
Bounds nowhere() {
    float infinity = uintBitsToFloat(0x7f800000u);
    return Bounds(vec3(infinity), vec3(-infinity));
}

Bounds around(Bounds a, Bounds b) {
    return Bounds(min(a.low, b.low), max(a.high, b.high));
}
