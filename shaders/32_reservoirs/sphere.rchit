#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "common/ray_offset.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec3 outward;

// The nearest hit is a sphere. The point is taken from the sphere and not from the ray, and 08 says how far
// above it a ray must start; the spheres' instance is placed nowhere else.
void main() {
    uint id = push.emitters.sphere_ids.at[gl_PrimitiveID];
    Emitter sphere = push.emitters.emitters.at[id];
    precise vec3 point = sphere.corner + sphere.radius * outward;
    hit.position = point;
    hit.face = faceforward(outward, gl_WorldRayDirectionEXT, outward);
    hit.offset = ROUNDING * dot(abs(outward), 31.0 * abs(point) + vec3(46.0 * sphere.radius));
    hit.t = gl_HitTEXT;
    // A sphere has one normal, and is as round as it looks.
    hit.normal = hit.face;
    hit.color = push.scene.materials.at[sphere.material].base_color;
    hit.material = sphere.material;
    hit.triangle = id;
    hit.instance = gl_InstanceCustomIndexEXT;
}
