#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;
hitAttributeEXT vec2 barycentrics;

// The nearest hit, not as it looks but as it is: what the looks need not know.
void main() {
    // A ray for a look has no business here: its stride is wrong.
    payload = vec4(1.0, 0.0, 1.0, -2.0);
    uint number = gl_InstanceCustomIndexEXT + gl_GeometryIndexEXT;
    InstanceRecord instance = push.scene.instances.at[number];
    uint triangle = instance.original.at[gl_PrimitiveID];
    if (push.show == SHOW_NORMAL) {
        Surface surface = surface_at(instance, triangle, barycentrics);
        vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
        vec3 face = vec3(surface.face * gl_WorldToObjectEXT);
        face = faceforward(face, gl_WorldRayDirectionEXT, face);
        normal = faceforward(normal, -face, normal);
        payload = vec4(0.5 + 0.5 * normal, 1.0);
    }
    if (push.show == SHOW_TRIANGLE) {
        payload = vec4(false_color(triangle), 1.0);
    }
    if (push.show == SHOW_HIT) {
        payload = vec4(number, triangle, gl_HitTEXT, gl_InstanceID);
    }
    if (push.show == SHOW_DIRECTION) {
        payload = vec4(gl_WorldRayDirectionEXT, gl_HitTEXT);
    }
    if (push.show == SHOW_GEOMETRY) {
        // From 5 on the first colours are easy to tell apart.
        payload = vec4(false_color(gl_GeometryIndexEXT + 5), gl_GeometryIndexEXT);
    }
}
