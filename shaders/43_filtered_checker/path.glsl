// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.

#include "common/views.glsl"

// ANCHOR: path
struct Path {
    vec4 color;        // what the eye sees so far
    vec3 throughput;   // the part of the next hit's light that reaches the eye
    uint bounce;       // the next ray's number: 0 comes from the camera
};

struct Ray {
    vec3 origin;
    vec3 direction;
    float width;       // of the cone of the pixel's rays, where this ray begins
};

// Adds what a ray meets. The picture is the sum over the path; every other view ends with the camera's ray.
void gather(inout Path path, vec4 seen) {
    if (SHOW == SHOW_PICTURE) {
        path.color += vec4(path.throughput * seen.rgb, path.bounce == 0 ? seen.a : 0.0);
    } else {
        path.color = seen;
    }
}

// True if the next ray is worth tracing.
bool goes_on(Path path) {
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    return SHOW == SHOW_PICTURE && path.bounce <= push.depth && contribution > 0.0
        && contribution >= push.minimum_contribution;
}
// ANCHOR_END: path

// The quantity a view shows of a hit, instead of the picture.
vec4 view_of(Hit hit, vec3 direction, RayOrigin start, float visible) {
    bool missed = hit.t < 0.0;
    bool plain = missed || hit.instance == PLANE;
    switch (SHOW) {
        case SHOW_TRIANGLE: return vec4(plain ? hit.color : false_color(hit.triangle), 1.0);
        case SHOW_HIT:
            return missed ? vec4(-1.0) : vec4(int(hit.instance), hit.triangle, hit.t, hit.material);
        default: return view_of(hit, direction, start.origin, visible);
    }
}

// Lights a hit, adds its light to the path, and sets up the next ray.
void advance(inout Path path, inout Ray ray, Hit hit) {
    // ANCHOR: light
    vec3 color = hit.color;
    RayOrigin start = shadow_start(hit);
    float visible = 1.0;
    vec3 mirror = vec3(0.0);
    if (hit.t >= 0.0) {
        MaterialRecord material;
        vec3 reflection = vec3(0.0);
        if (hit.instance == PLANE) {
            material = board_material(push.world.board);
            reflection = vec3(push.world.board.reflection);
        } else {
            material = push.scene.materials.at[hit.material];
            if (material.illumination >= ILLUMINATION_MIRROR) {
                reflection = material.specular;
            }
        }
        if (reflection != vec3(0.0)) {
            mirror = fresnel(reflection, max(dot(hit.normal, -ray.direction), 0.0));
        }
        // Reflected light does not reach the colour below.
        hit.color *= 1.0 - mirror;
        DirectionalLight light = push.world.light;
        visible = visibility(start, light.direction, 1e30);
        color = material.emission + hit.color * ambient(hit.normal)
            + lit_by(visible * light.radiance, light.direction, hit, material, -ray.direction);
    }
    // ANCHOR_END: light
    bool is_picture = SHOW == SHOW_PICTURE;
    gather(path, is_picture ? vec4(color, 1.0) : view_of(hit, ray.direction, start, visible));
    path.throughput *= mirror;
    path.bounce++;
    ray.origin = hit.position + hit.offset * hit.face;
    ray.direction = mirrored(ray.direction, hit.normal, hit.face);
}
