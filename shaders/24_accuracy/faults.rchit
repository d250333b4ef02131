#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "faults.glsl"

layout(location = 0) rayPayloadInEXT Seen seen;
hitAttributeEXT Marks marks;

// Compares the hit attributes with those written.
void main() {
    seen.primitive = gl_PrimitiveID;
    if (differ(marks, marks_of(gl_PrimitiveID, gl_WorldRayDirectionEXT))) {
        seen.wrong |= WRONG_CLOSEST_HIT;
    }
}
