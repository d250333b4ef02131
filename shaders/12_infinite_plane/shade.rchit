#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/report.glsl"
#include "curvature.glsl"

layout(location = 0) rayPayloadInEXT CurvedHit seen;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: what surface it is, and where.
void main() {
    seen.hit = report(push.scene, barycentrics);
    InstanceRecord instance = push.scene.instances.at[seen.hit.instance];
    seen.curvature = curvature(instance, seen.hit.triangle);
}
