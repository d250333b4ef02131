#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "shape.glsl"
#include "hit.glsl"
#include "report.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec3 outward;

// The nearest hit is a sphere or a box: the intersection shader has left its normal. The point is taken
// from the shape and not from the ray.
void main() {
    precise vec3 point;
    vec3 own = vec3(0.0);
    uint number = 0;
    float curvature = 0.0;
#ifdef EFFECT_SPHERES
    if (gl_HitKindEXT == KIND_SPHERE) {
        Sphere sphere = push.world.spheres.at[gl_PrimitiveID];
        point = center_at(sphere, time_of(gl_RayTminEXT)) + sphere.radius * outward;
        own = abs(point) + vec3(46.0 * sphere.radius);
        number = sphere.material;
        curvature = 1.0 / sphere.radius;
    }
#endif
#ifdef EFFECT_BOXES
    if (gl_HitKindEXT == KIND_BOX) {
        Box box = push.world.boxes.at[gl_PrimitiveID];
        point = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
        point = mix(point, box.low, lessThan(outward, vec3(0.0)));
        point = mix(point, box.high, greaterThan(outward, vec3(0.0)));
        point = clamp(point, box.low, box.high);
        number = box.material;
    }
#endif
    hit = report(point, outward, own, curvature, number);
#if defined(EFFECT_PATTERNS) && defined(EFFECT_SPHERES) && defined(EFFECT_MOTION_BLUR)
    // A pattern moves with its ball.
    if (gl_HitKindEXT == KIND_SPHERE && finish_of(number).pattern != PATTERN_PLAIN) {
        hit.color = point - time_of(gl_RayTminEXT) * push.world.spheres.at[gl_PrimitiveID].moves;
    }
#endif
#if defined(CHANCES) && defined(EFFECT_SPHERES)
    if (gl_HitKindEXT == KIND_SPHERE && push.world.emitters.column_count > 0) {
        hit.emitter = push.world.emitters.sphere_ids.at[gl_PrimitiveID];
    }
#endif
}
