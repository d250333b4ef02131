// The lamp, as seen by a ray that meets it by chance.

// The lamp is a disk that faces whoever looks at it (35). What reaches a surface at distance 1 from all of it
// is its strength: so its radiance is the strength over the area. `t` is how far the ray came.
vec3 seen_of_light(DiskLight lamp, vec3 origin, vec3 direction, float t) {
    vec3 axis = towards_light(lamp.light, origin);
    float along = dot(axis, direction);
    float distance = dot(axis, axis) / along;
    vec3 aside = distance * direction - axis;
    bool hidden = t >= 0.0 && distance > t;
    if (along <= 0.0 || hidden || dot(aside, aside) >= lamp.radius * lamp.radius) {
        return vec3(0.0);
    }
    return lamp.light.strength / (3.14159265 * lamp.radius * lamp.radius);
}
