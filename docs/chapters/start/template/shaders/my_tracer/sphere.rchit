#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec3 outward;

void main() {
    hit.color = vec3(0.8, 0.2, 0.1);
    vec3 normal = normalize(vec3(outward * gl_WorldToObjectEXT));
    // Turned to the eye, which may be inside.
    hit.normal = faceforward(normal, gl_WorldRayDirectionEXT, normal);
    hit.t = gl_HitTEXT;
}
