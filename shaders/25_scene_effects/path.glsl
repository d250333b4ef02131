// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.
#include "ray.glsl"
#include "lighting.glsl"
#ifdef EFFECT_MIRROR
#include "common/mirror.glsl"
#endif
#if defined(EFFECT_BOUNCES) || defined(EFFECT_GLASS)
#include "common/numbers.glsl"
#include "common/surface.glsl"
#endif
#ifdef EFFECT_GLASS
#include "glass.glsl"
#endif

// ANCHOR: path
// What a path must still be able to add to a pixel.
const float MINIMUM_CONTRIBUTION = 1.0 / 512.0;

struct Path {
    uvec2 pixel;         // whose colour it makes
    uint sample_index;   // which of the pixel's samples this is
    uint bounce;         // the next ray's number: 0 comes from the camera
    vec3 color;          // what the eye sees so far
#ifdef PATHS
    vec3 throughput;     // what part of the light at the end of the next ray reaches the eye
#endif
#ifdef EFFECT_BOUNCES
    uint bounces;        // how often it was scattered
#endif
#ifdef EFFECT_GLASS
    uvec4 media;         // the bodies of glass that the next ray is in
#endif
};

// Whether the next ray is worth tracing.
bool goes_on(Path path) {
#ifdef PATHS
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    uint reflected = path.bounce;
#ifdef EFFECT_BOUNCES
    reflected -= path.bounces;
#endif
    return reflected <= push.world.depth && contribution >= MINIMUM_CONTRIBUTION;
#else
    return false;
#endif
}
// ANCHOR_END: path

#if defined(EFFECT_BOUNCES) || defined(EFFECT_GLASS)
vec2 numbers(Path path, uint dimension) {
    return numbers(path.pixel, path.sample_index, path.bounce, dimension, 0);
}
#endif

// What was met is made of, its colour apart; and what that mirrors, looked at straight.
MaterialRecord material_of(Hit hit, out vec3 reflection) {
    MaterialRecord material;
    material.specular = vec3(0.0);
    material.shininess = 1.0;
    material.emission = vec3(0.0);
    reflection = vec3(0.0);
#ifdef EFFECT_PLANE
    if (hit.material == MATERIAL_PLANE) {
        material.specular = vec3(0.03);
        material.shininess = 90.0;
        reflection = vec3(push.world.board.reflection);
    }
#endif
    if (hit.material < MATERIAL_GROUND) {
        material = push.scene.materials.at[hit.material];
        reflection = material.illumination >= 3 ? material.specular : vec3(0.0);
    }
    return material;
}

#ifdef EFFECT_BOUNCES
// ANCHOR: bounced
// A surface mirrors or scatters what comes next: one of the two, and the likelier the more light comes that
// way (chapter 11). Returns whether it scatters; then the path has gone on.
bool bounced(inout Path path, inout Ray ray, Hit hit, vec3 mirror) {
    float mirrors = largest(mirror) / max(largest(mirror) + largest(hit.color), 1e-30);
    if (numbers(path, DIMENSION_CHOICE).x < mirrors) {
        path.throughput /= mirrors;
        return false;
    }
    vec3 on = cosine_direction(numbers(path, DIMENSION_BOUNCE), hit.normal);
    ray.direction = kept_above(on, hit.face);
    ray.origin = hit.position + hit.height * hit.face;
    path.throughput *= hit.color / (1.0 - mirrors);
    path.bounces++;
    path.bounce++;
    return true;
}
// ANCHOR_END: bounced
#endif

// ANCHOR: advance
// What a ray has met is lit and gathered, and says which ray comes next.
void advance(inout Path path, inout Ray ray, Hit hit) {
    vec3 color = hit.color;
    vec3 mirror = vec3(0.0);
#ifdef EFFECT_GLASS
    path.throughput *= left_on_way(path.media, hit);
    Glass glass = glass_of(hit);
    // Below its surface nothing scatters.
    hit.color *= glass.kind == GLASS_NONE ? 1.0 : 0.0;
#endif
#ifdef EFFECT_BOUNCES
    bool scatters = false;
#endif
    if (hit.t >= 0.0) {
        vec3 reflection;
        MaterialRecord material = material_of(hit, reflection);
#ifdef EFFECT_MIRROR
        if (reflection != vec3(0.0) && push.world.depth != 0) {
            mirror = fresnel(reflection, max(dot(hit.normal, -ray.direction), 0.0));
        }
        // What is reflected does not reach the colour below.
        hit.color *= 1.0 - mirror;
#endif
        vec3 around = ambient(hit.normal);
#ifdef EFFECT_BOUNCES
        // The next ray finds out what comes from around; after the last one that is taken to be the sky's.
        scatters = path.bounces < push.world.bounces && hit.color != vec3(0.0);
        around *= scatters ? 0.0 : 1.0;
        // What is scattered meets few highlights, and each would be a bright dot.
        material.specular *= path.bounces > 0 ? 0.0 : 1.0;
#endif
        color = material.emission + hit.color * around;
        for (uint i = 0; i < LIGHTS && i < push.world.light_count; i++) {
            Light light = light_of(i);
            float visible = 1.0;
#ifdef SHADOWS
            if (casts_shadows(light, i)) {
                vec2 first = vec2(0.0);
#ifdef EFFECT_AREA_LIGHT
                first = random(path.pixel, path.sample_index, path.bounce, DIMENSION_LIGHT).xy;
#endif
                visible = visibility(light, hit, first);
            }
#endif
            color += lit_by(light, hit, material, -ray.direction, visible);
        }
    }
#ifdef PATHS
    path.color += path.throughput * color;
#ifdef CONES
    ray.width += ray.spread * hit.t;
#endif
#ifdef EFFECT_PLANE
    ray.on_plane = hit.material == MATERIAL_PLANE;
#endif
#ifdef EFFECT_GLASS
    if (glass.kind != GLASS_NONE) {
        float chance = numbers(path, DIMENSION_CHOICE).x;
        path.throughput *= pass(ray, path.media, hit, glass, chance);
        path.bounce++;
        return;
    }
#endif
#ifdef EFFECT_BOUNCES
    if (scatters && bounced(path, ray, hit, mirror)) {
        return;
    }
#endif
    path.throughput *= mirror;
    path.bounce++;
    ray.origin = hit.position + hit.height * hit.face;
#ifdef EFFECT_MIRROR
    ray.direction = mirrored(ray.direction, hit.normal, hit.face);
#ifdef CURVES
    // A curved mirror turns what comes along the cone's sides apart, by twice the angle of its normals.
    ray.spread += 2.0 * hit.curvature * ray.width;
#endif
#endif
#else
    path.color = color;
#endif
}
// ANCHOR_END: advance
