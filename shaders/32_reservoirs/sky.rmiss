#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

// The ray hit nothing: it sees the sky.
void main() {
    hit.t = -1.0;
    vec3 day = sky(gl_WorldRayDirectionEXT);
    hit.color = SKY == SKY_DAY ? day : SKY == SKY_NIGHT ? vec3(0.02, 0.035, 0.08) * day : vec3(0.0);
}
