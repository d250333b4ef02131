// How a light lights a surface that a ray has met. A shadow ray finds out whether the light reaches the
// surface. The including shader defines how this ray is traced.

// Whether nothing lies between a point above a surface and a point of the light.
bool is_lit(Start start, vec3 to_light, float end);

// ANCHOR: visibility
// What part of a light reaches a surface, 0 to 1. One ray tells if the light has no size; else several
// rays go to points of it, which begin at the random numbers `first`. Each starts where its direction
// asks for.
float visibility(Light light, Hit hit, Departure from, vec2 first) {
    // On a round surface that is made of triangles, up is where the smooth normal points.
    vec3 up = hit.lift != vec3(0.0) ? hit.normal : hit.face;
    bool soft = light.size > 0.0;
    uint count = soft ? light.samples : 1;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, first) : vec2(0.0);
        vec3 to_light = towards_light(light, hit.position + hit.lift, point);
        Start start = start_of_ray(from, to_light);
        start.origin += hit.lift;
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(up, to_light) > 0.0 && is_lit(start, to_light, light_end(light))) {
            seen++;
        }
    }
    return float(seen) / float(count);
}
// ANCHOR_END: visibility

// Which way a light's middle lies.
vec3 light_direction(Light light, Hit hit) {
    return normalize(towards_light(light, hit.position + hit.lift, vec2(0.0)));
}

// The light of a lamp that a surface sends to the eye, in direction `view`. The part `visible` of the lamp's
// light arrives at the surface.
vec3 lit_by(Light light, Hit hit, MaterialRecord material, vec3 to_light, vec3 view, float visible) {
    return visible * arriving_light(light, hit.position + hit.lift)
        * reflect_light(hit.color, material.specular, material.shininess, hit.normal, view, to_light);
}
