#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "common/ray_offset.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec3 outward;

// The hit point from center and radius, without t, which is less exact from afar. A ray that starts this far above the
// surface does not hit it again: the offset covers more than all roundings together.
HitPoint hit_point() {
    vec3 up = normalize(outward);
    HitPoint at;
    at.position = push.center + push.radius * up;
    at.offset = 64.0 * ROUNDING * (length(push.center) + push.radius);
    at.face = faceforward(up, gl_WorldRayDirectionEXT, up);
    return at;
}

// The nearest hit is the sphere: it has one normal, and the material of the instance's custom index.
void main() {
    HitPoint at = hit_point();
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    hit.normal = at.face;
    hit.instance = gl_InstanceCustomIndexEXT;
    hit.material = push.scene.instances.at[hit.instance].material;
    hit.color = push.scene.materials.at[hit.material].base_color;
    hit.triangle = gl_PrimitiveID;
}
