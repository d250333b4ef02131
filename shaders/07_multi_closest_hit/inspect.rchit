#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;
hitAttributeEXT vec2 weights;

// The nearest hit, not as it looks but as it is: what the looks need not know.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    if (push.show == SHOW_NORMAL) {
        Surface surface = surface_at(instance, triangle, weights);
        vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
        normal = faceforward(normal, gl_WorldRayDirectionEXT, normal);
        payload = vec4(0.5 + 0.5 * normal, 1.0);
    }
    if (push.show == SHOW_TRIANGLE) {
        payload = vec4(false_color(triangle), 1.0);
    }
    if (push.show == SHOW_HIT) {
        payload = vec4(gl_InstanceCustomIndexEXT, triangle, gl_HitTEXT, gl_InstanceID);
    }
    if (push.show == SHOW_DIRECTION) {
        payload = vec4(gl_WorldRayDirectionEXT, gl_HitTEXT);
    }
}
