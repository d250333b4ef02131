#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "query.glsl"

layout(location = 0) rayPayloadInEXT Answer payload;
hitAttributeEXT vec3 normal;

void main() {
    payload.hit = 1;
    payload.t = gl_HitTEXT;
    payload.normal = normal;
}
