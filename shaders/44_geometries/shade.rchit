#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "look.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// The nearest hit: normal, material and light give the colour.
void main() {
    uint number = gl_InstanceCustomIndexEXT + gl_GeometryIndexEXT;
    InstanceRecord instance = push.scene.instances.at[number];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    vec3 normal = world_normal(surface);
    vec3 view = -gl_WorldRayDirectionEXT;

    vec3 base = look.tint;
    if (material.base_texture >= 0) {
        base *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    vec3 light = push.light.direction;
    vec3 color = material.emission + base * ambient(normal);
    color += push.light.radiance
        * reflect_light(base, material.specular, material.shininess, normal, view, light);

    payload = answer(GROUP_PLAIN, color);
}
