#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

// Meadows, dry on the tops of hills; snow on what is high; and rock where it is steep, or seen from below.
vec3 color(float height, vec3 face) {
    vec3 meadow = mix(vec3(0.05, 0.13, 0.03), vec3(0.5, 0.4, 0.14), smoothstep(-1.2, 1.9, height));
    vec3 cover = mix(meadow, vec3(0.85, 0.88, 0.92), smoothstep(8.0, 12.0, height));
    return mix(vec3(0.3, 0.24, 0.19), cover, smoothstep(0.3, 0.75, face.y));
}

// The hit again, from the formula and not from the ray: its height is what a march computes there.
//
// Sets the height above the ground at which a leaving ray starts, so that a march finds the start above it. A
// march computes a height in the box that is off by `error` at most. That is the sum of two parts: the
// roundings of the formula, which move the hit, and three roundings of a place. One of the three is that of
// the start. A step h along the normal leads h·sqrt(1 + slope²) up from the slope, from which the
// ground bends away by less than bend·h². With h = 2·error there is more than `error` left.
void place_on_ground() {
    HeightfieldShape shape = push.ground.shape;
    precise vec3 point = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
    hit.position = vec3(point.x, heightfield_height(shape, point.xz), point.z);
    hit.face = heightfield_normal(shape, point.xz);
    // A ray falls on the ground, or it comes up from below.
    hit.face = faceforward(hit.face, gl_WorldRayDirectionEXT, hit.face);
    hit.offset = 2.0 * push.ground.error;
}

// The nearest hit is the ground.
void main() {
    place_on_ground();
    hit.t = gl_HitTEXT;
    hit.normal = hit.face;
    hit.color = color(hit.position.y, hit.face);
    hit.material = push.ground.material;
    hit.triangle = gl_PrimitiveID;
    hit.instance = gl_InstanceCustomIndexEXT;
}
