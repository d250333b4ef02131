#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/report.glsl"

layout(location = 0) rayPayloadInEXT StrandHit seen;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: what surface it is, and where.
void main() {
    seen.hit = report(push.scene, barycentrics);
    seen.along = -1.0;
}
