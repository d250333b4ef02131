// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.
#include "common/media.glsl"
#include "light_disk.glsl"

struct Path {
    uvec2 pixel;       // whose colour it makes
    vec3 color;        // what the eye sees so far
    vec3 throughput;   // the part of the next hit's light that reaches the eye
    uint bounce;       // the next ray's number: 0 comes from the camera
    bool lamp_counted; // true if a shadow ray from the next ray's origin has already counted the lamp
    uvec4 media;       // the bodies that the next ray is in
};

struct Ray {
    vec3 origin;
    vec3 direction;
};

vec2 numbers(Path path, uint dimension) {
    return numbers(path.pixel, push.sample_index, path.bounce, dimension, push.seed);
}

// Adds the light of a hit, or of the sky.
void gather(inout Path path, vec3 seen) {
    vec3 light = path.throughput * seen;
    if (path.bounce > 0 && push.most > 0.0) {
        light *= push.most / max(largest(light), push.most);
    }
    path.color += light;
}

// True if the next ray is worth tracing. Clear glass absorbs nothing, so only the depth ends a path in it.
bool goes_on(inout Path path) {
    float contribution = largest(path.throughput);
    if (path.bounce > push.depth || contribution <= 0.0) {
        return false;
    }
    if (path.bounce > 1 && contribution < 1.0) {
        // A path that goes on also counts for those that end here.
        path.throughput /= contribution;
        return numbers(path, DIMENSION_ROULETTE).x < contribution;
    }
    return true;
}

// A ray met glass, and goes one of two ways.
void pass(inout Path path, inout Ray ray, BodyHit seen, Glass glass) {
    Hit hit = seen.hit;
    // ANCHOR: between
    uvec4 beyond = path.media;
    if (glass.kind == GLASS_THICK) {
        beyond = seen.entering ? entered(path.media, hit.material) : left(path.media, hit.material);
    }
    uint inner = glass.kind == GLASS_THIN ? hit.material : beyond.x;
    bool is_real = inner != path.media.x;
    float from = path.media.x == AIR ? 1.0 : push.world.glasses.at[path.media.x].index;
    float to = inner == AIR ? 1.0 : push.world.glasses.at[inner].index;
    // ANCHOR_END: between
    // ANCHOR: choice
    // Near an outline the ray may come from behind the smooth normal; it never does so from behind the face.
    vec3 normal = dot(ray.direction, hit.normal) < 0.0 ? hit.normal : hit.face;
    Split split = Split(vec2(0.0), vec2(1.0));
    if (is_real) {
        split = fresnel_exact(min(dot(-ray.direction, normal), 1.0), from, to);
    }
    if (glass.kind == GLASS_THIN) {
        split = of_sheet(split);
    }
    float chance = SHOW == SHOW_PICTURE ? numbers(path, DIMENSION_CHOICE).x : 0.9999999;
    float side = 1.0;
    if (chance < unpolarised(split.reflected)) {
        ray.direction = mirrored(ray.direction, normal, hit.face);
    } else {
        if (glass.kind == GLASS_THIN) {
            path.throughput *= left_after(glass.absorption);
        } else if (is_real) {
            ray.direction = kept_above(refracted(ray.direction, normal, from, to), -hit.face);
        }
        path.media = beyond;
        side = -1.0;
    }
    ray.origin = hit.position + side * hit.offset * hit.face;
    // ANCHOR_END: choice
    // A shadow ray does not see through glass: the light behind it is met by chance.
    path.lamp_counted = false;
}

// Lights and gathers the surface that a ray has met, and chooses the next ray.
void advance(inout Path path, inout Ray ray, BodyHit seen) {
    Hit hit = seen.hit;
    // ANCHOR: absorb
    if (path.media.x != AIR && hit.t >= 0.0) {
        path.throughput *= left_after(hit.t * push.world.glasses.at[path.media.x].absorption);
    }
    // ANCHOR_END: absorb
    // ANCHOR: chance
    if (!path.lamp_counted) {
        gather(path, seen_of_light(push.world.light, ray.origin, ray.direction, hit.t));
    }
    // ANCHOR_END: chance
    if (hit.t < 0.0) {
        gather(path, hit.color);
        path.throughput = vec3(0.0);
        path.bounce++;
        return;
    }
    Glass glass = push.world.glasses.at[hit.material];
    if (glass.kind != GLASS_NONE) {
        pass(path, ray, seen, glass);
        path.bounce++;
        return;
    }
    MaterialRecord material = push.world.scene.materials.at[hit.material];
    vec3 color = hit.color;
    float to_eye = max(dot(hit.normal, -ray.direction), 0.0);
    bool polished = material.illumination >= ILLUMINATION_MIRROR;
    // ANCHOR: light
    gather(path, material.emission);
    // From within glass, a shadow ray would only find glass.
    bool asks = path.media.x == AIR;
    if (asks) {
        RayOrigin start = shadow_start(hit);
        vec2 point = disk_point(0, 1, numbers(path, DIMENSION_LIGHT));
        vec3 to_light = towards_disk(push.world.light, start.origin, point);
        float visible = visibility(start, to_light, light_end(push.world.light.light));
        hit.color = scattered(material, color, to_eye, max(dot(hit.normal, normalize(to_light)), 0.0));
        MaterialRecord lit = material;
        // A mirror meets the light by chance: its image is the highlight.
        lit.specular *= polished ? 0.0 : kept_of_highlight(material.shininess);
        vec3 arriving = visible * arriving_from(push.world.light, start.origin, to_light);
        gather(path, lit_by(arriving, to_light, hit, lit, -ray.direction));
    }
    // ANCHOR_END: light
    vec3 mirror = polished ? fresnel(material.specular, to_eye) : vec3(0.0);
    vec3 rest = color * (1.0 - (polished ? mirror : material.specular));
    // One of the two ways, chosen the more often the more light it brings.
    float mirrors = largest(mirror) / max(largest(mirror) + largest(rest), 1e-30);
    if (numbers(path, DIMENSION_CHOICE).x < mirrors) {
        path.throughput *= mirror / mirrors;
        ray.direction = mirrored(ray.direction, hit.normal, hit.face);
        path.lamp_counted = false;
    } else {
        vec3 on = cosine_direction(numbers(path, DIMENSION_BOUNCE), hit.normal);
        ray.direction = kept_above(on, hit.face);
        float to_next = max(dot(hit.normal, ray.direction), 0.0);
        path.throughput *= scattered(material, color, to_eye, to_next) / (1.0 - mirrors);
        path.lamp_counted = asks;
    }
    path.bounce++;
    ray.origin = hit.position + hit.offset * hit.face;
}
