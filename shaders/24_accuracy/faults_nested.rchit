#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "faults.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

layout(location = 0) rayPayloadInEXT Seen seen;
layout(location = 1) rayPayloadEXT Seen back;
hitAttributeEXT Marks marks;

// Compares the hit attributes with those written; then traces a ray back through the box, whose hit has attributes
// of its own, and compares once more.
void main() {
    seen.primitive = gl_PrimitiveID;
    Marks expected = marks_of(gl_PrimitiveID, gl_WorldRayDirectionEXT);
    if (differ(marks, expected)) {
        seen.wrong |= WRONG_CLOSEST_HIT;
    }
    if (seen.nested == 0) {
        back = Seen(NOTHING, 0, 1);
        traceRayEXT(
            tlas,
            gl_RayFlagsNoneEXT,
            0xff,            // cull mask: every instance
            0,               // sbtRecordOffset
            0,               // sbtRecordStride: one record for all
            0,               // missIndex: faults.rmiss
            gl_WorldRayOriginEXT + 2.0 * gl_HitTEXT * gl_WorldRayDirectionEXT,
            0.0,
            -gl_WorldRayDirectionEXT,
            1e30,
            1                // payload location
        );
        if (differ(marks, expected)) {
            seen.wrong |= WRONG_AFTER_TRACE;
        }
        if (back.primitive != gl_PrimitiveID || back.wrong != 0) {
            seen.wrong |= WRONG_NESTED;
        }
    }
}
