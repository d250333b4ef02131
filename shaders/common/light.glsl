// Taught by 05_shadow_miss.
//
// Lights: the way to them from a point, and what arrives there.

const uint LIGHT_DIRECTIONAL = 0;
const uint LIGHT_POINT = 1;

struct Light {
    vec3 place;      // directional: the unit vector towards it; point: its position
    uint kind;
    vec3 strength;   // directional: radiance; point: intensity, which is what arrives at distance 1
    float size;      // radius of the disk that shines, around `place`; 0 for a mere point
    uint samples;    // shadow rays a hit, where it has a size
};

// ANCHOR: disk
// Point i of n on the unit disk: a sunflower's spiral, started by two random numbers. Each point alone
// is uniform on the disk, and all together leave no gaps (Vogel 1979).
vec2 disk_point(uint i, uint n, vec2 start) {
    float radius = sqrt((float(i) + start.x) / float(n));
    // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
    float angle = 6.283185 * (fract(0.618033989 * float(i) + start.y + 0.5) - 0.5);
    return radius * vec2(cos(angle), sin(angle));
}
// ANCHOR_END: disk

// ANCHOR: towards
// From a point to the light, or to a point of its disk, which faces the point that looks at it.
// The light is at t = 1 along it, unless it is directional: then there is no end.
vec3 towards_light(Light light, vec3 from, vec2 on_disk) {
    vec3 axis = light.kind == LIGHT_POINT ? light.place - from : light.place;
    if (light.size == 0.0) {
        return axis;
    }
    vec3 aside = abs(axis.y) < 0.9 * length(axis) ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 right = normalize(cross(aside, axis));
    vec3 up = normalize(cross(axis, right));
    return axis + light.size * (on_disk.x * right + on_disk.y * up);
}

// Where a ray along `towards_light` ends.
float light_end(Light light) {
    return light.kind == LIGHT_POINT ? 1.0 : 1e30;
}
// ANCHOR_END: towards

// ANCHOR: arriving
// What arrives at a surface that faces the light: a point light's strength falls with the square of
// the distance.
vec3 arriving_light(Light light, vec3 from) {
    if (light.kind == LIGHT_DIRECTIONAL) {
        return light.strength;
    }
    vec3 axis = light.place - from;
    return light.strength / dot(axis, axis);
}
// ANCHOR_END: arriving
