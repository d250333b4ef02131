// Taught by 29_emitters.
//
// The directions in which a matte surface scatters light.

// The density of `kept_above(cosine_direction(u, normal), up)`: of a direction, and of the one that is
// mirrored to it.
float likelihood(vec3 direction, vec3 normal, vec3 up) {
    float above = dot(direction, up);
    vec3 other = direction - 2.0 * above * up;
    float both = max(dot(direction, normal), 0.0) + max(dot(other, normal), 0.0);
    return above > 0.0 ? both / 3.14159265 : 0.0;
}
