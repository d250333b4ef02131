#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"

layout(location = 0) rayPayloadInEXT BodyHit seen;

// The ray hit nothing: it sees the sky.
void main() {
    seen.hit.t = -1.0;
    vec3 day = sky(gl_WorldRayDirectionEXT);
    seen.hit.color = SKY == SKY_WHITE ? vec3(1.0) : SKY == SKY_DAY ? day : 0.3 * day * day;
}
