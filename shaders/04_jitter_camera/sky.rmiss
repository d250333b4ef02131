#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;

// The ray hit nothing: it sees the sky.
void main() {
    payload = vec4(sky(gl_WorldRayDirectionEXT), 1.0);
    if (SHOW == SHOW_HIT) {
        payload = vec4(-1.0);
    }
    if (SHOW == SHOW_DIRECTION) {
        payload = vec4(gl_WorldRayDirectionEXT, -1.0);
    }
}
