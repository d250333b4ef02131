// The queries of the atlas on a device's traversal, and the result of a ray.

struct Aim {
    vec3 origin;
    float tmin;
    vec3 direction;
    float tmax;
};

// A primitive that the device says the ray meets, and where.
struct Met {
    uint primitive;
    float t;
    vec2 barycentrics;   // of the second and the third corner
};

struct Found {
    Met nearest;    // NOTHING where the ray met none
    uint calls;     // of the any-hit shader; those beyond MOST are counted, and not noted
};

// The number of calls recorded per ray.
const uint MOST = 16;
const uint NOTHING = 0xffffffffu;

layout(buffer_reference, scalar) readonly buffer Aims { Aim at[]; };
layout(buffer_reference, scalar) writeonly buffer Founds { Found at[]; };
layout(buffer_reference, scalar) writeonly buffer Calls { Met at[]; };
// Three corners a primitive, for the software's triangles.
layout(buffer_reference, scalar) readonly buffer Corners { vec3 at[]; };
// Three corners a ray, where the device hands them out.
layout(buffer_reference, scalar) writeonly buffer Fetched { vec3 at[]; };

layout(push_constant, scalar) uniform Push {
    Aims aims;
    Founds founds;
    Calls calls;
    Corners corners;
    Fetched fetched;
    uint count;
} push;

uint ray_number() {
    return gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
}
