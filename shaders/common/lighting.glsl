// Taught by 05_shadow_miss.
//
// The light that a surface sends to the eye. A shadow ray finds out whether light arrives; the including
// shader defines how this ray is traced.

// True if nothing lies between a point above a surface and the light.
bool is_lit(vec3 origin, vec3 to_light, float end);

// ANCHOR: start
// Where a shadow ray starts, and which way is up there.
struct RayOrigin {
    vec3 origin;
    vec3 up;
};

RayOrigin shadow_start(Hit hit) {
    return RayOrigin(hit.position + hit.offset * hit.face, hit.face);
}
// ANCHOR_END: start

// 1 if light arrives, else 0. The light is at t = `end` in the direction `to_light`.
float visibility(RayOrigin start, vec3 to_light, float end) {
    // A light below the surface is hidden by the surface itself: that needs no ray.
    return dot(start.up, to_light) > 0.0 && is_lit(start.origin, to_light, end) ? 1.0 : 0.0;
}

// The light that a surface sends to the eye, in direction `view`, of the light that arrives from a direction.
vec3 lit_by(vec3 arriving, vec3 to_light, Hit hit, MaterialRecord material, vec3 view) {
    return arriving * reflect_light(hit.color, material.specular, material.shininess, hit.normal, view,
        normalize(to_light));
}
