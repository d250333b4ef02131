// Taught by 34_lights.
//
// Lights: the way to them from a point, and what arrives there.

const uint LIGHT_DIRECTIONAL = 0;
const uint LIGHT_POINT = 1;

struct Light {
    vec3 place;      // directional: the unit vector towards it; point: its position
    uint kind;
    vec3 strength;   // directional: radiance; point: intensity, the light that arrives at distance 1
};

// ANCHOR: towards
// From a point to the light, which is at t = 1 along it. A directional light is infinitely far away: the ray
// to it has no end.
vec3 towards_light(Light light, vec3 from) {
    return light.kind == LIGHT_POINT ? light.place - from : light.place;
}

// The end of a ray along `towards_light`.
float light_end(Light light) {
    return light.kind == LIGHT_POINT ? 1.0 : 1e30;
}
// ANCHOR_END: towards

// The light that arrives at a surface facing it: a point light's strength falls with the square of
// the distance.
vec3 arriving_light(Light light, vec3 from) {
    if (light.kind == LIGHT_DIRECTIONAL) {
        return light.strength;
    }
    vec3 axis = light.place - from;
    return light.strength / dot(axis, axis);
}
