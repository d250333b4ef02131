// Taught by 11_path_tracing.
//
// The light that a surface reflects: a mirror on top, if it is polished, and below it a colour that scatters.
#include "common/mirror.glsl"

float largest(vec3 v) {
    return max(max(v.r, v.g), v.b);
}

// ANCHOR: polish
// The part of the light that passes the polish, from outside or from below, relative to a head-on ray.
float through(float cosine) {
    float grazing = 1.0 - cosine;
    return 1.0 - grazing * grazing * grazing * grazing * grazing;
}

// The colour that scatters light from a direction to the eye, both given by their cosines to the normal.
// Below polish it is weaker, the lower light or eye are. It is the same if light and eye change places.
// The sum over all directions is `color` times the light that the mirror does not reflect.
vec3 scattered(MaterialRecord material, vec3 color, float to_eye, float to_light) {
    vec3 left = color * (1.0 - material.specular);
    return material.illumination < ILLUMINATION_MIRROR ? left
        : left * (21.0 / 20.0) * through(to_eye) * through(to_light);
}
// ANCHOR_END: polish

// The part of its strength in 05 that a highlight keeps, so that it never reflects more light than arrives.
float kept_of_highlight(float shininess) {
    return (shininess + 2.0) * (shininess + 4.0)
        / ((shininess + 8.0) * (shininess + exp2(-0.5 * shininess)));
}

// ANCHOR: cosine
// A random direction above a surface, with a density proportional to its cosine to the normal: a uniform point
// of the unit disk, lifted onto the hemisphere (Malley's method).
vec3 cosine_direction(vec2 u, vec3 normal) {
    float radius = sqrt(u.x);
    // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
    float angle = 6.283185 * (u.y - 0.5);
    vec3 local = vec3(radius * cos(angle), radius * sin(angle), sqrt(1.0 - u.x));
    // Two vectors across the normal (Duff et al., JCGT 6:1, 2017).
    float side = normal.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    vec3 right = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    vec3 up = vec3(b, side + normal.y * normal.y * a, -normal.y);
    return normalize(local.x * right + local.y * up + local.z * normal);
}

// Interpolated normals may send a direction into the triangle; such a direction is mirrored at the triangle.
vec3 kept_above(vec3 direction, vec3 face) {
    return normalize(direction - 2.0 * min(dot(direction, face), 0.0) * face);
}
// ANCHOR_END: cosine
