#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;

// The ray hit nothing: it sees the sky.
void main() {
    payload.color = vec4(sky(gl_WorldRayDirectionEXT), 1.0);
    if (SHOW == SHOW_HIT) {
        payload.color = vec4(-1.0);
    }
    if (SHOW == SHOW_DIRECTION) {
        payload.color = vec4(gl_WorldRayDirectionEXT, -1.0);
    }
}
