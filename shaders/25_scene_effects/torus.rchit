#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "report.glsl"
#include "common/torus_quartic.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec3 place;

// The nearest hit is a torus (chapter 33).
void main() {
    Torus torus = push.world.tori.at[gl_PrimitiveID];
    TorusCrossing at = crossing_at(gl_HitTEXT, place, normalize(torus.axis), gl_ObjectRayDirectionEXT);
    TorusFrame frame = TorusFrame(at.ring, at.outward);
    float roundings;
    vec3 point = torus_point(torus, frame, roundings);
    vec3 own = vec3(roundings) + 4.0 * abs(point) + 2.0 * abs(torus.center);
    // As round as the tube.
    hit = report(point, frame.outward, own, 1.0 / torus.minor, torus.material);
}
