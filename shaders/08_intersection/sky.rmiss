#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/shape_hit.glsl"

layout(location = 0) rayPayloadInEXT ShapeHit seen;

// The ray hit nothing: it sees the sky.
void main() {
    seen.hit.t = -1.0;
    seen.hit.color = sky(gl_WorldRayDirectionEXT);
}
