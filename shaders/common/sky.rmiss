#version 460
// Taught by 05_shadow_miss.
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "common/hit.glsl"
#include "common/shade.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

// The ray hit nothing: it sees the sky.
void main() {
    hit.t = -1.0;
    hit.color = sky(gl_WorldRayDirectionEXT);
}
