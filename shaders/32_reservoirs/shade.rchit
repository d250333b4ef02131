#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "common/report.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: what surface it is, and where.
void main() {
    hit = report(push.scene, barycentrics);
}
