// The light, as seen by a ray that meets it by chance.

// ANCHOR: disk
// The light is a disk that faces whoever looks at it (05). What reaches a surface from all of it is its
// strength: so its radiance is the strength over the area. `t` is how far the ray came.
vec3 seen_of_light(Light light, vec3 origin, vec3 direction, float t) {
    vec3 axis = light.kind == LIGHT_POINT ? light.place - origin : light.place;
    float along = dot(axis, direction);
    float distance = dot(axis, axis) / along;
    vec3 aside = distance * direction - axis;
    bool hidden = t >= 0.0 && (light.kind == LIGHT_DIRECTIONAL || distance > t);
    if (along <= 0.0 || hidden || dot(aside, aside) >= light.size * light.size) {
        return vec3(0.0);
    }
    return light.strength / (3.14159265 * light.size * light.size);
}
// ANCHOR_END: disk
