#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "report.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT Crossing crossing;

// The nearest hit is a strand (chapter 18).
void main() {
    Segment segment = push.world.segments.at[gl_PrimitiveID];
    Node a = push.world.nodes.at[segment.first];
    Node b = push.world.nodes.at[segment.first + 1];
    vec3 own;
    float radius;
    vec3 point = strand_point(a, b, crossing, own, radius);
    // Across, as round as the ball there; a tip is rounder than any number.
    hit = report(point, crossing.outward, own, 1.0 / max(radius, 1e-6), segment.material);
}
