// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.
#include "common/views.glsl"

// ANCHOR: path
struct Path {
    vec4 color;        // what the eye sees so far
    vec3 throughput;   // the part of the next hit's light that reaches the eye
    uint bounce;       // the next ray's number: 0 comes from the camera
};

// Adds what a ray meets. The picture is the sum over the path; every other view shows one ray's.
void gather(inout Path path, vec4 seen) {
    if (SHOW == SHOW_PICTURE) {
        path.color += vec4(path.throughput * seen.rgb, path.bounce == 0 ? seen.a : 0.0);
    } else if (path.bounce == push.bounce) {
        path.color = seen;
    }
}

// True if the next ray is worth tracing.
bool goes_on(Path path) {
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    return path.bounce <= push.depth && contribution > 0.0
        && contribution >= push.minimum_contribution;
}
// ANCHOR_END: path

// The quantity a view shows of a hit, instead of the picture.
vec4 view_of(Hit hit, Ray ray, RayOrigin start, float visible) {
    switch (SHOW) {
        case SHOW_RAY_ORIGIN: return vec4(ray.start.origin, ray.start.tmin);
        default: return view_of(hit, ray.direction, start.origin, visible);
    }
}

// Lights a hit, adds its light to the path, and sets up the next ray.
void advance(inout Path path, inout Ray ray, TriangleHit seen) {
    Hit hit = seen.hit;
    vec3 color = hit.color;
    RayOrigin start = RayOrigin(vec3(0.0), 0.0);
    float visible = 1.0;
    vec3 mirror = vec3(0.0);
    Ray next = ray;
    if (hit.t >= 0.0) {
        // ANCHOR: light
        Departure from = departure(seen, push.scene.instances.at[hit.instance], ray);
        start = start_of_ray(from, push.light.direction);
        visible = visibility(hit, start, push.light.direction);
        // Fetched after the shadow ray: a material would wait in registers for it.
        MaterialRecord material = push.scene.materials.at[hit.material];
        if (material.illumination >= ILLUMINATION_MIRROR) {
            mirror = fresnel(material.specular, max(dot(hit.normal, -ray.direction), 0.0));
        }
        // Reflected light does not reach the colour below.
        hit.color *= 1.0 - mirror;
        color = material.emission + hit.color * ambient(hit.normal)
            + lit_by(visible * push.light.radiance, push.light.direction, hit, material, -ray.direction);
        // ANCHOR_END: light
        // ANCHOR: next
        next.direction = mirrored(ray.direction, hit.normal, hit.face);
        next.start = start_of_ray(from, next.direction);
        // ANCHOR_END: next
    }
    bool is_picture = SHOW == SHOW_PICTURE;
    gather(path, is_picture ? vec4(color, 1.0) : view_of(hit, ray, start, visible));
    path.throughput *= mirror;
    path.bounce++;
    ray = next;
}
