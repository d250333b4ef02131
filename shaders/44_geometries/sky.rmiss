#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;

// The ray hit nothing: it sees the sky.
void main() {
    payload = vec4(sky(gl_WorldRayDirectionEXT), 1.0);
    if (push.show == SHOW_HIT || push.show == SHOW_GROUP || push.show == SHOW_RECORD
        || push.show == SHOW_GEOMETRY) {
        payload = vec4(-1.0);
    }
    if (push.show == SHOW_DIRECTION) {
        payload = vec4(gl_WorldRayDirectionEXT, -1.0);
    }
}
