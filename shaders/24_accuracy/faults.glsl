// The rays that look for known faults of drivers, and the result of each.

struct Aim {
    vec3 origin;
    uint wanted;     // the primitive to report; all others are passed
    vec3 direction;
};

struct Seen {
    uint primitive;  // NOTHING for a miss
    uint wrong;      // bit 0: hit attributes that the any-hit shader got wrong; 1: the closest hit shader; 2: after
                     // that had traced a ray of its own; 3: with that ray
    uint nested;     // 1 for the ray of a closest hit shader
};

const uint NOTHING = 0xffffffffu;
const uint WRONG_ANY_HIT = 1;
const uint WRONG_CLOSEST_HIT = 2;
const uint WRONG_AFTER_TRACE = 4;
const uint WRONG_NESTED = 8;

layout(buffer_reference, scalar) readonly buffer Aims { Aim at[]; };
layout(buffer_reference, scalar) writeonly buffer Results { Seen at[]; };

layout(push_constant, scalar) uniform Push {
    Aims aims;
    Results results;
    uint count;
} push;

uint ray_number() {
    return gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
}

// As many bytes as every device must offer for hit attributes.
struct Marks {
    uvec4 a;
    uvec4 b;
};

// Differs between primitives, and between a ray and the one that comes back.
Marks marks_of(uint primitive, vec3 direction) {
    uint first = primitive * 0x9e3779b9u ^ (direction.z < 0.0 ? 0x55555555u : 0);
    uvec4 a = first * uvec4(1, 3, 5, 7);
    return Marks(a, a * 9 + 1);
}

bool differ(Marks one, Marks other) {
    return one.a != other.a || one.b != other.b;
}
