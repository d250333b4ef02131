#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "rough_hit.glsl"
#include "common/sky_map.glsl"

layout(location = 0) rayPayloadInEXT RoughHit rough;

// The ray hit nothing: it sees the sky.
void main() {
    Texel texel = texel_at(push.sky, push.rotation, gl_WorldRayDirectionEXT);
    rough.hit.t = -1.0;
    rough.hit.color = texel.radiance;
    rough.density = texel.density;
}
