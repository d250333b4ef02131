#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "06_reflection/push.glsl"
#include "common/hit.glsl"
#include "common/lighting.glsl"
#include "common/mirror.glsl"
#include "06_reflection/path.glsl"

layout(location = 0) rayPayloadInEXT Path path;

// The ray hit nothing: it sees the sky, and the path ends.
void main() {
    Hit hit;
    hit.t = -1.0;
    hit.color = sky(gl_WorldRayDirectionEXT);
    vec4 view = view_of(hit, gl_WorldRayDirectionEXT, vec3(0.0), 1.0);
    gather(path, SHOW == SHOW_PICTURE ? vec4(hit.color, 1.0) : view);
}
