#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/report.glsl"

layout(location = 0) rayPayloadInEXT BodyHit seen;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: what surface it is, and where.
void main() {
    seen.hit = report(push.world.scene, barycentrics);
    // A normal without faceforward looks out of the body.
    InstanceRecord instance = push.world.scene.instances.at[seen.hit.instance];
    vec3 out_of = vec3(surface_at(instance, seen.hit.triangle, barycentrics).face * gl_WorldToObjectEXT);
    seen.entering = dot(out_of, seen.hit.face) > 0.0;
}
