// The lamp: a disk that faces whoever looks at it (35) and shines evenly. A shadow ray and a ray that happens
// to meet it count the same light.

// The light of a small disk that reaches a surface at distance 1 is its strength, so its radiance is the
// strength over its area.
vec3 radiance_of(DiskLight lamp) {
    return lamp.light.strength / (3.14159265 * lamp.radius * lamp.radius);
}

// ANCHOR: by_shadow_ray
// The light that a point of the disk stands for, at a surface that faces it: the radiance times the solid
// angle that the disk would have if all of it were like this point. The mean over all points is the disk's
// light. Near the rim a point is farther away than the middle, and shines at an angle.
vec3 arriving_from(DiskLight lamp, vec3 from, vec3 to_point) {
    float axis = length(towards_light(lamp.light, from));
    float way = length(to_point);
    float cosine = axis / way;
    return lamp.light.strength * cosine / (way * way);
}
// ANCHOR_END: by_shadow_ray

// The light of the disk for a ray that happens to hit it; `t` is the distance of the ray's own hit, if any.
vec3 seen_of_light(DiskLight lamp, vec3 origin, vec3 direction, float t) {
    vec3 axis = towards_light(lamp.light, origin);
    float along = dot(axis, direction);
    float distance = dot(axis, axis) / along;
    vec3 aside = distance * direction - axis;
    bool hidden = t >= 0.0 && distance > t;
    if (along <= 0.0 || hidden || dot(aside, aside) >= lamp.radius * lamp.radius) {
        return vec3(0.0);
    }
    return radiance_of(lamp);
}
