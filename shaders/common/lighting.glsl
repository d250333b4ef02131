// Taught by 05_shadow_miss.
//
// How a light lights a surface that a ray has met. A shadow ray finds out whether the light reaches the
// surface. The including shader defines how this ray is traced.

// Whether nothing lies between a point above a surface and a point of the light.
bool is_lit(vec3 origin, vec3 to_light, float end);

// ANCHOR: start
// Where a shadow ray starts, and which way is up there.
struct Start {
    vec3 origin;
    vec3 up;
};

Start shadow_start(Hit hit) {
    // On a round surface that is made of triangles, up is where the smooth normal points.
    bool lifted = hit.lift != vec3(0.0);
    return Start(hit.position + hit.height * hit.face + hit.lift, lifted ? hit.normal : hit.face);
}
// ANCHOR_END: start

// ANCHOR: visibility
// What part of a light reaches a surface, 0 to 1. One ray tells if the light has no size; else several
// rays go to points of it, which begin at the random numbers `first`.
float visibility(Light light, Start start, vec2 first) {
    bool soft = light.size > 0.0;
    uint count = soft ? light.samples : 1;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, first) : vec2(0.0);
        vec3 to_light = towards_light(light, start.origin, point);
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(start.up, to_light) > 0.0 && is_lit(start.origin, to_light, light_end(light))) {
            seen++;
        }
    }
    return float(seen) / float(count);
}
// ANCHOR_END: visibility

// ANCHOR: light
// The light of a lamp that a surface sends to the eye, in direction `view`. The part `visible` of the lamp's
// light arrives at the surface.
vec3 lit_by(Light light, Hit hit, MaterialRecord material, Start start, vec3 view, float visible) {
    vec3 to_light = normalize(towards_light(light, start.origin, vec2(0.0)));
    return visible * arriving_light(light, start.origin)
        * reflect_light(hit.color, material.specular, material.shininess, hit.normal, view, to_light);
}
// ANCHOR_END: light
