#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 barycentrics;

// ANCHOR: main
// A triangle of the scene: its colour is its material's, and its normal is turned to the eye.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    Surface surface = surface_at(instance, instance.original.at[gl_PrimitiveID], barycentrics);
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    hit.color = push.scene.materials.at[instance.material].base_color;
    hit.normal = faceforward(normal, gl_WorldRayDirectionEXT, normal);
    hit.t = gl_HitTEXT;
}
// ANCHOR_END: main
