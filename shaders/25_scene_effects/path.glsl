// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.
#include "ray.glsl"
#include "lighting.glsl"
#ifdef EFFECT_MIRROR
#include "common/mirror.glsl"
#endif
#if defined(RANDOM_DIRECTIONS) || defined(EFFECT_GLASS) || defined(SAMPLED_LIGHT)
#define NUMBERS
#include "common/path_numbers.glsl"
#include "common/surface.glsl"
#endif

// ANCHOR: path
// The least that a path must still be able to add to a pixel.
const float MINIMUM_CONTRIBUTION = 1.0 / 512.0;

struct Path {
    uint sample_index;   // which of the pixel's samples this is
    uint bounce;         // the next ray's number: 0 comes from the camera
    vec3 color;          // what the eye sees so far
    vec3 throughput;     // the part of the next hit's light that reaches the eye
#ifdef EFFECT_BOUNCES
    uint bounces;        // how often it was scattered
#endif
#ifdef EFFECT_GLASS
    uvec4 media;         // the bodies of glass that the next ray is in
#endif
#ifdef FOUND_TWICE
    float density;       // of the next ray's direction; NO_OTHER if no shadow ray could have gone there
#endif
};

// The camera, a mirror and glass leave no choice.
const float NO_OTHER = -1.0;

// True if the next ray is worth tracing.
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

#ifdef NUMBERS
vec2 numbers(Path path, uint dimension) {
    return numbers(pixel_id(), path.sample_index, path.bounce, dimension, 0);
}
#endif

#ifdef EFFECT_GLASS
#include "glass.glsl"
#endif
#ifdef EFFECT_ROUGH_METAL
#include "rough.glsl"
#endif
#include "scatterer.glsl"
#ifdef SAMPLED_LIGHT
#include "sampled_light.glsl"
#endif

// The material of a hit, without its colour; and its reflectance seen straight on.
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
// A surface mirrors or scatters what comes next: one of the two, and the likelier the more light comes that
// way (chapter 11). Returns whether it scatters, and with what probability it does.
bool scatters(inout Path path, vec3 color, vec3 mirror, out float matte) {
    float mirrors = largest(mirror) / max(largest(mirror) + largest(color), 1e-30);
    matte = 1.0 - mirrors;
    if (numbers(path, DIMENSION_CHOICE).x < mirrors) {
        path.throughput *= mirror / mirrors;
        return false;
    }
    path.throughput *= color / matte;
    return true;
}
#endif

// Where a path goes on from a surface.
const uint WAY_MIRROR = 0;
const uint WAY_BOUNCE = 1;
const uint WAY_GLASS = 2;
const uint WAY_ROUGH = 3;

// Lights a hit, adds its light to the path, and sets up the next ray.
void advance(inout Path path, inout Ray ray, Hit hit) {
#if defined(PATHS) && defined(CONES)
    ray.width += ray.spread * hit.t;
#endif
    uint way = WAY_MIRROR;
    Scatterer by;
    by.matte = 0.0;
#ifdef EFFECT_ROUGH_METAL
    by.surface.roughness = -1.0;
#endif
#ifdef EFFECT_GLASS
    path.throughput *= left_on_way(path.media, hit.t);
    if (is_glass(hit)) {
        way = WAY_GLASS;
        hit.color = vec3(0.0);   // below its surface nothing scatters
    }
#endif
    // The part of this ray's light that reaches the eye. The next ray's throughput is computed before any light
    // is sampled, so that fewer values stay alive.
    vec3 reaching = path.throughput;
    if (hit.t < 0.0) {
#if defined(EFFECT_ENVIRONMENT) && defined(FOUND_TWICE)
        hit.color *= part_of_sky(path, hit);
#endif
        path.color += reaching * hit.color;
        path.throughput = vec3(0.0);
    } else {
        vec3 mirror = vec3(0.0);
        vec3 reflection;
        MaterialRecord material = material_of(hit, reflection);
#ifdef EFFECT_ROUGH_METAL
        MicrofacetRecord facets = microfacet_of(hit);
        if (facets.roughness >= 0.0) {
            way = WAY_ROUGH;
            // A row vector times a matrix is the transposed product: from the world into the frame.
            vec3 view = -ray.direction * frame_of(hit.normal);
            by.surface = microfacets(push.rough, hit.color, facets.roughness, facets.metallic, view);
            hit.color = with_ways_left(path, by.surface, by.continues);
        }
#endif
#ifdef EFFECT_MIRROR
        if (reflection != vec3(0.0) && push.world.depth != 0) {
            mirror = fresnel(reflection, max(dot(hit.normal, -ray.direction), 0.0));
        }
        // Reflected light does not reach the colour below.
        hit.color *= 1.0 - mirror;
#endif
        vec3 around = push.world.sky * ambient(hit.normal);
#ifdef EFFECT_BOUNCES
        // A highlight that is met by chance would be a bright dot.
        material.specular *= path.bounces > 0 ? 0.0 : 1.0;
        if (way != WAY_ROUGH && path.bounces < push.world.bounces && hit.color != vec3(0.0)) {
            // The next ray finds out what comes from around; after the last one that is taken to be the sky's.
            around = vec3(0.0);
            way = scatters(path, hit.color, mirror, by.matte) ? WAY_BOUNCE : WAY_MIRROR;
        } else
#endif
        if (way == WAY_MIRROR) {
            path.throughput *= mirror;
        }
#ifdef CHANCES
        if (material.emission != vec3(0.0)) {
            material.emission *= part_by_chance(path, ray, hit);
        }
#endif
        path.color += reaching * (material.emission + hit.color * around);
#ifdef EFFECT_ROUGH_METAL
        // Its colour is that of the microfacets.
        hit.color = way == WAY_ROUGH ? vec3(1.0) : hit.color;
#endif
        hit.color *= reaching;
        material.specular *= reaching;
#ifdef SAMPLED_LIGHT
        add_sampled(path, hit, by);
#endif
#ifdef SHADOWS
        RayOrigin start = shadow_start(hit);
#endif
        for (uint i = 0; i < LIGHTS && i < push.world.light_count; i++) {
            DiskLight disk = light_of(i);
            float visible = 1.0;
#ifdef SHADOWS
            if (casts_shadows(disk.light, i)) {
                vec2 first = vec2(0.0);
#ifdef EFFECT_AREA_LIGHT
                first = random(pixel_id(), path.sample_index, path.bounce, DIMENSION_LIGHT).xy;
#endif
                visible = visibility(disk, start, hit, first);
            }
#endif
#ifdef EFFECT_ROUGH_METAL
            if (way == WAY_ROUGH) {
                path.color += lit_by(disk.light, hit, by.surface, visible);
                continue;
            }
#endif
            path.color += lit_by(disk.light, hit, material, -ray.direction, visible);
        }
    }
#ifdef PATHS
    float side = 1.0;
#ifdef FOUND_TWICE
    path.density = NO_OTHER;
#endif
#ifdef EFFECT_GLASS
    if (way == WAY_GLASS) {
        side = pass(path, ray, hit) ? -1.0 : 1.0;
    } else
#endif
#ifdef EFFECT_ROUGH_METAL
    if (way == WAY_ROUGH) {
        float choice = numbers(path, DIMENSION_CHOICE).x;
        Bounce next = bounce(by.surface, choice, numbers(path, DIMENSION_BOUNCE));
        path.throughput *= by.continues * next.weight;
#ifdef FOUND_TWICE
        path.density = density_of(by.surface, choice, next);
#endif
        ray.direction = next.is_mirrored ? mirrored(ray.direction, hit.normal, hit.face)
            : kept_above(frame_of(hit.normal) * next.direction, hit.face);
        bool by_facet = choice < by.surface.polished;
#ifdef CURVES
        ray.spread += by_facet ? 2.0 * hit.curvature * ray.width : 0.0;
#endif
#ifdef EFFECT_BOUNCES
        path.bounces += by_facet ? 0 : 1;
#endif
    } else
#endif
#ifdef EFFECT_BOUNCES
    if (way == WAY_BOUNCE) {
        vec3 on = cosine_direction(numbers(path, DIMENSION_BOUNCE), hit.normal);
        ray.direction = kept_above(on, hit.face);
#ifdef FOUND_TWICE
        // The throughput was divided by `by.matte`: so that has not to be kept while lights are asked for.
        float again = largest(hit.color) / max(largest(path.throughput), 1e-30);
        path.density = again * likelihood(ray.direction, hit.normal, hit.face);
#endif
        path.bounces++;
    } else
#endif
    {
#ifdef EFFECT_MIRROR
        ray.direction = mirrored(ray.direction, hit.normal, hit.face);
#endif
#ifdef CURVES
        // A curved mirror turns what comes along the cone's sides apart, by twice the angle of its normals.
        ray.spread += 2.0 * hit.curvature * ray.width;
#endif
    }
    ray.origin = hit.position + side * hit.offset * hit.face;
#ifdef EFFECT_PLANE
    ray.on_plane = hit.material == MATERIAL_PLANE;
#endif
    path.bounce++;
#endif
}
