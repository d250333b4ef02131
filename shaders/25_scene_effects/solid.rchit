#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "report.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT uint face;

// The nearest hit is a face of a convex solid.
void main() {
    Solid solid = push.world.solids.at[gl_PrimitiveID];
    Face wall = push.world.faces.at[solid.first + face];
    // Onto the face, which rounding has left.
    precise vec3 f = gl_WorldRayOriginEXT - solid.center + gl_HitTEXT * gl_WorldRayDirectionEXT;
    precise vec3 on_face = f + (wall.distance - dot(wall.normal, f)) * wall.normal;
    precise vec3 point = solid.center + on_face;
    // The point is off by a few roundings of its distance from the centre, and the next ray's test,
    // a sum of three products, by as many.
    vec3 own = abs(point) + vec3(12.0 * length(on_face));
    hit = report(point, wall.normal, own, 0.0, solid.material);
}
