// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.
#include "ray.glsl"
#include "lighting.glsl"
#ifdef EFFECT_MIRROR
#include "common/mirror.glsl"
#endif

// ANCHOR: path
// What a path must still be able to add to a pixel.
const float MINIMUM_CONTRIBUTION = 1.0 / 512.0;

struct Path {
    uvec2 pixel;         // whose colour it makes
    uint sample_index;   // which of the pixel's samples this is
    uint bounce;         // the next ray's number: 0 comes from the camera
    vec3 color;          // what the eye sees so far
#ifdef EFFECT_MIRROR
    vec3 throughput;     // what part of the light at the end of the next ray reaches the eye
#endif
};

// Whether the next ray is worth tracing.
bool goes_on(Path path) {
#ifdef EFFECT_MIRROR
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    return path.bounce <= push.world.depth && contribution >= MINIMUM_CONTRIBUTION;
#else
    return false;
#endif
}
// ANCHOR_END: path

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

// ANCHOR: advance
// What a ray has met is lit and gathered, and says which ray comes next.
void advance(inout Path path, inout Ray ray, Hit hit) {
    vec3 color = hit.color;
    vec3 mirror = vec3(0.0);
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
        color = material.emission + hit.color * ambient(hit.normal);
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
#ifdef EFFECT_MIRROR
    path.color += path.throughput * color;
    path.throughput *= mirror;
    path.bounce++;
    ray.origin = hit.position + hit.height * hit.face;
    ray.direction = mirrored(ray.direction, hit.normal, hit.face);
#ifdef EFFECT_PLANE
    ray.on_plane = hit.material == MATERIAL_PLANE;
#endif
#ifdef CURVES
    // A curved mirror turns what comes along the cone's sides apart, by twice the angle of its normals.
    ray.width += ray.spread * hit.t;
    ray.spread += 2.0 * hit.curvature * ray.width;
#endif
#else
    path.color = color;
#endif
}
// ANCHOR_END: advance
