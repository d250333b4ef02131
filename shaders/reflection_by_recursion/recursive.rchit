#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "06_reflection/push.glsl"
#include "common/hit.glsl"
#include "common/lighting.glsl"
#include "common/mirror.glsl"
#include "06_reflection/path.glsl"
#include "common/shadow.glsl"
#include "common/report.glsl"

layout(location = 0) rayPayloadInEXT Path path;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: lit here, and the mirrored ray is traced from here.
void main() {
    // ANCHOR: trace
    // The built-in variables are read before anything is traced: afterwards the software driver
    // returns those of the last ray traced.
    Hit hit = report(push.scene, barycentrics);
    Ray ray = Ray(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT);
    advance(path, ray, hit);
    if (goes_on(path)) {
        traceRayEXT(
            tlas,
            gl_RayFlagsNoneEXT,
            0xff,                       // cull mask: every instance
            0,                          // sbtRecordOffset: the first hit record of the instance
            1,                          // sbtRecordStride: one record per geometry
            0,                          // missIndex: recursive.rmiss
            ray.origin,
            0.0,                        // tmin
            ray.direction,
            1e30,                       // tmax
            0                           // payload location: the one that came in goes on
        );
    }
    // ANCHOR_END: trace
}
