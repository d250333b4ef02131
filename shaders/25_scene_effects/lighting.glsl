// The light of the world's lights that a surface sends to the eye.

#ifdef SHADOW_RAYS
#include "shadow.glsl"
#endif

#ifdef SHADOWS
// Where shadow rays start.
struct RayOrigin {
    vec3 origin;
    bool is_offset;    // to the round surface that triangles stand for
};

RayOrigin shadow_start(Hit hit) {
    RayOrigin start = RayOrigin(hit.position + hit.offset * hit.face, false);
#ifdef TERMINATOR
    start.origin += hit.terminator_offset;
    start.is_offset = hit.terminator_offset != vec3(0.0);
#endif
    return start;
}

// True if shadow rays go to a light.
bool casts_shadows(Light light, uint number) {
#ifndef EFFECT_POINT_SHADOWS
    if (light.kind == LIGHT_POINT) {
        return false;
    }
#endif
#ifndef EFFECT_DIRECTIONAL_SHADOWS
    if (light.kind == LIGHT_DIRECTIONAL) {
        return false;
    }
#endif
    return (push.world.shadows >> number & 1) != 0;
}

// The part of a light that reaches a surface, 0 to 1. One ray tells if the light has no size; else rays go to
// points of it, which begin at the random numbers `first`.
float visibility(DiskLight disk, RayOrigin start, Hit hit, vec2 first) {
#ifdef EFFECT_AREA_LIGHT
    bool soft = disk.radius > 0.0;
    uint count = soft ? push.world.light_samples : 1;
#else
    const bool soft = false;
    const uint count = 1;
    disk.radius = 0.0;
#endif
    bool on_plane = hit.material == MATERIAL_PLANE;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, first) : vec2(0.0);
        vec3 to_light = towards_disk(disk, start.origin, point);
        // A light below the surface is hidden by the surface itself and needs no ray. On a round surface, up is
        // the direction of the normal to shade with.
        vec3 up = start.is_offset ? hit.normal : hit.face;
        if (dot(up, to_light) > 0.0
            && is_lit(start.origin, to_light, light_end(disk.light), on_plane)) {
            seen++;
        }
    }
    return float(seen) / float(count);
}
#endif

// A light of the world. If all are of one kind, that kind is a constant for the compiler.
DiskLight light_of(uint number) {
    DiskLight disk = push.world.lights[number];
    disk.light.kind = LIGHT_KINDS == 1 ? LIGHT_DIRECTIONAL
        : LIGHT_KINDS == 2 ? LIGHT_POINT
        : disk.light.kind;
    return disk;
}

// The light of a lamp that a surface sends to the eye, in direction `view`. The part `visible` of the lamp's
// light arrives at the surface. The point itself is lit, not the one that shadow rays leave: without shadows
// there is no such point.
vec3 lit_by(Light light, Hit hit, MaterialRecord material, vec3 view, float visible) {
    vec3 to_light = normalize(towards_light(light, hit.position));
    return visible * arriving_light(light, hit.position)
        * reflect_light(hit.color, material.specular, material.shininess, hit.normal, view, to_light);
}
