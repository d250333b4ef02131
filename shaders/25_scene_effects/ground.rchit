#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

// The nearest hit is the ground: what chapter 21 reports of it. The raygen shader paints it.
void main() {
    HeightfieldShape shape = push.world.ground.shape;
    precise vec3 point = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
    vec3 up = heightfield_normal(shape, point.xz);
    hit.position = vec3(point.x, heightfield_height(shape, point.xz), point.z);
    hit.t = gl_HitTEXT;
    hit.normal = faceforward(up, gl_WorldRayDirectionEXT, up);
    hit.material = MATERIAL_GROUND;
    hit.color = vec3(0.0);
#ifdef DEPARTURES
    hit.offset = 2.0 * push.world.ground.error;
    hit.face = hit.normal;
#endif
#ifdef TERMINATOR
    hit.terminator_offset = vec3(0.0);
#endif
#ifdef CHANCES
    hit.emitter = NO_EMITTER;
#endif
#ifdef CURVES
    hit.curvature = 0.0;
#endif
#ifdef EFFECT_HISTORY
    hit.surface = SURFACE_GROUND << 16 | 255u;
#endif
}
