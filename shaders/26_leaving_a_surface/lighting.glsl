// The light that a surface sends to the eye. Like lighting.glsl in 05_shadow_miss, but the start of the shadow
// ray depends on its direction.

// True if nothing lies between a start above a surface and the light.
bool is_lit(RayOrigin start, vec3 to_light);

// 1 if light arrives from a direction, else 0.
float visibility(Hit hit, RayOrigin start, vec3 to_light) {
    // A light below the surface is hidden by the surface itself: that needs no ray.
    return dot(hit.face, to_light) > 0.0 && is_lit(start, to_light) ? 1.0 : 0.0;
}

// The light that a surface sends to the eye, in direction `view`, of the light that arrives from a direction.
vec3 lit_by(vec3 arriving, vec3 to_light, Hit hit, MaterialRecord material, vec3 view) {
    return arriving * reflect_light(hit.color, material.specular, material.shininess, hit.normal, view,
        normalize(to_light));
}
