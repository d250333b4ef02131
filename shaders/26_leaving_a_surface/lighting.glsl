// How light lights a surface that a ray has met. Like lighting.glsl in 05_shadow_miss, but the shadow ray
// starts where its direction asks for.

// Whether nothing lies between a start above a surface and the light.
bool is_lit(RayOrigin start, vec3 to_light);

RayOrigin shadow_start(Hit hit, Departure from, vec3 to_light) {
    RayOrigin start = start_of_ray(from, to_light);
    start.origin += hit.lift;
    return start;
}

// 1 if light arrives from a direction, else 0.
float visibility(Hit hit, RayOrigin start, vec3 to_light) {
    // On a round surface that is made of triangles, up is where the smooth normal points.
    vec3 up = hit.lift != vec3(0.0) ? hit.normal : hit.face;
    // What is below the surface, the surface itself hides; that needs no ray.
    return dot(up, to_light) > 0.0 && is_lit(start, to_light) ? 1.0 : 0.0;
}

// What a surface sends to the eye, in direction `view`, of the light that arrives at it from a direction.
vec3 lit_by(vec3 arriving, vec3 to_light, Hit hit, MaterialRecord material, vec3 view) {
    return arriving * reflect_light(hit.color, material.specular, material.shininess, hit.normal, view,
        normalize(to_light));
}
