// Glass: a path goes on through a surface, and knows which bodies it is in (chapter 27).
#include "common/mirror.glsl"
#include "common/media.glsl"

// What was met is for light that enters it. No ray goes on at depth 0: there glass is opaque.
Glass glass_of(Hit hit) {
    Glass glass = Glass(vec3(0.0), 1.0, GLASS_NONE);
    if (hit.t >= 0.0 && hit.material < push.world.glass_count && push.world.depth != 0) {
        glass = push.world.glasses.at[hit.material];
    }
    return glass;
}

uvec4 media_of_camera() {
    uint first[4] = push.world.media;
    return uvec4(first[0], first[1], first[2], first[3]);
}

// What a ray's way through a body leaves of the light.
vec3 left_on_way(uvec4 media, Hit hit) {
    bool is_air = media.x == AIR || hit.t < 0.0;
    return is_air ? vec3(1.0) : left_after(hit.t * push.world.glasses.at[media.x].absorption);
}

// ANCHOR: pass
// A ray met glass, and goes one of two ways: `chance`, from 0 to 1, says which. Returns what of the light is
// left on it, and changes the media that it is in.
vec3 pass(inout Ray ray, inout uvec4 media, Hit hit, Glass glass, float chance) {
    uvec4 beyond = media;
    if (glass.kind == GLASS_THICK) {
        beyond = hit.entering ? entered(media, hit.material) : left(media, hit.material);
    }
    uint inner = glass.kind == GLASS_THIN ? hit.material : beyond.x;
    bool is_real = inner != media.x;
    float from = media.x == AIR ? 1.0 : push.world.glasses.at[media.x].index;
    float to = inner == AIR ? 1.0 : push.world.glasses.at[inner].index;
    // Near an outline the ray may come from behind the smooth normal; it never does so from behind the face.
    vec3 normal = dot(ray.direction, hit.normal) < 0.0 ? hit.normal : hit.face;
    Split split = Split(0.0, 1.0);
    if (is_real) {
        split = fresnel_exact(min(dot(-ray.direction, normal), 1.0), from, to);
    }
    if (glass.kind == GLASS_THIN) {
        split = of_sheet(split);
    }
    if (chance < split.reflected) {
        ray.direction = mirrored(ray.direction, normal, hit.face);
        ray.origin = hit.position + hit.height * hit.face;
#ifdef CURVES
        ray.spread += 2.0 * hit.curvature * ray.width;
#endif
        return vec3(1.0);
    }
    if (glass.kind == GLASS_THICK && is_real) {
        ray.direction = kept_above(refracted(ray.direction, normal, from, to), -hit.face);
    }
    ray.origin = hit.position - hit.height * hit.face;
    media = beyond;
    return glass.kind == GLASS_THIN ? left_after(glass.absorption) : vec3(1.0);
}
// ANCHOR_END: pass
