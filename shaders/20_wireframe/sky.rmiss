#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;

// The ray hit nothing: it sees the sky, or white paper.
void main() {
    payload = vec4(SHOW == SHOW_LINES ? vec3(1.0) : sky(gl_WorldRayDirectionEXT), 0.0);
}
