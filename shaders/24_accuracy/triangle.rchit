#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "query.glsl"

layout(location = 0) rayPayloadInEXT Answer payload;

// The device has met a triangle itself: its normal, on the side that the ray comes from.
void main() {
    uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
    uint first = push.queries.at[i].first + 9 * gl_PrimitiveID;
    vec3 corner[3];
    for (uint k = 0; k < 3; k++) {
        uint at = first + 3 * k;
        corner[k] = vec3(push.numbers.at[at], push.numbers.at[at + 1], push.numbers.at[at + 2]);
    }
    vec3 normal = normalize(cross(corner[1] - corner[0], corner[2] - corner[0]));
    payload.hit = 1;
    payload.t = gl_HitTEXT;
    payload.normal = faceforward(normal, gl_WorldRayDirectionEXT, normal);
}
