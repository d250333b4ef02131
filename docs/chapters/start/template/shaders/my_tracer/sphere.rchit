#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
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
