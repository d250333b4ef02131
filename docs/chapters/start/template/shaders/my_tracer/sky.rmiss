#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

void main() {
    hit.color = sky(gl_WorldRayDirectionEXT);
    hit.t = -1.0;
}
