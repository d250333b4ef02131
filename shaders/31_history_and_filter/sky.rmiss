#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

// The ray hit nothing: it sees the sky.
void main() {
    hit.t = -1.0;
    hit.color = SKY == SKY_DAY ? sky(gl_WorldRayDirectionEXT) : vec3(SKY == SKY_WHITE);
}
