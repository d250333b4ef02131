// Glass: a path goes on through a surface, and knows which bodies it is in (chapter 27).
#include "common/mirror.glsl"
#include "common/media.glsl"

// True if light enters the surface. No ray goes on at depth 0: there glass is opaque.
bool is_glass(Hit hit) {
    return hit.t >= 0.0 && hit.material < push.world.glass_count && push.world.depth != 0
        && push.world.glasses.at[hit.material].kind != GLASS_NONE;
}

uvec4 media_of_camera() {
    uint first[4] = push.world.media;
    return uvec4(first[0], first[1], first[2], first[3]);
}

// The part of the light that is left after a ray's way through a body.
vec3 left_on_way(uvec4 media, float way) {
    bool is_air = media.x == AIR || way < 0.0;
    return is_air ? vec3(1.0) : left_after(way * push.world.glasses.at[media.x].absorption);
}

// A ray met glass, and goes one of two ways. Returns whether it goes through.
bool pass(inout Path path, inout Ray ray, Hit hit) {
    Glass glass = push.world.glasses.at[hit.material];
    uvec4 beyond = path.media;
    if (glass.kind == GLASS_THICK) {
        beyond = hit.entering ? entered(path.media, hit.material) : left(path.media, hit.material);
    }
    uint inner = glass.kind == GLASS_THIN ? hit.material : beyond.x;
    bool is_real = inner != path.media.x;
    float from = path.media.x == AIR ? 1.0 : push.world.glasses.at[path.media.x].index;
    float to = inner == AIR ? 1.0 : push.world.glasses.at[inner].index;
    // Near an outline the ray may come from behind the smooth normal; it never does so from behind the face.
    vec3 normal = dot(ray.direction, hit.normal) < 0.0 ? hit.normal : hit.face;
    Split split = Split(vec2(0.0), vec2(1.0));
    if (is_real) {
        split = fresnel_exact(min(dot(-ray.direction, normal), 1.0), from, to);
    }
    if (glass.kind == GLASS_THIN) {
        split = of_sheet(split);
    }
    if (numbers(path, DIMENSION_CHOICE).x < unpolarised(split.reflected)) {
        ray.direction = mirrored(ray.direction, normal, hit.face);
#ifdef CURVES
        ray.spread += 2.0 * hit.curvature * ray.width;
#endif
        return false;
    }
    if (glass.kind == GLASS_THIN) {
        path.throughput *= left_after(glass.absorption);
    } else if (is_real) {
        ray.direction = kept_above(refracted(ray.direction, normal, from, to), -hit.face);
    }
    path.media = beyond;
    return true;
}
