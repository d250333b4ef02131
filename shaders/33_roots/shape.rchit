#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "common/hit_point.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT TorusFrame frame;

// The point, and the height above the surface at which the next ray may start.
HitPoint hit_point_on_torus(Torus torus) {
    float own;
    HitPoint at;
    at.position = torus_point(torus, frame, own);
    at.face = faceforward(frame.outward, gl_WorldRayDirectionEXT, frame.outward);
    at.offset = ROUNDING * (own + dot(abs(at.face), 4.0 * abs(at.position) + 2.0 * abs(torus.center)));
    return at;
}

// The nearest hit is a torus. Its instance does not move it: object and world are one space.
void main() {
    uint id = push.shapes.ids.at[gl_PrimitiveID];
    Torus torus = push.shapes.tori.at[id];
    HitPoint at = hit_point_on_torus(torus);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    // A shape has one normal.
    hit.normal = hit.face;
    hit.color = push.scene.materials.at[torus.material].base_color;
    hit.material = torus.material;
    hit.triangle = id;
    hit.instance = gl_InstanceCustomIndexEXT;
}
