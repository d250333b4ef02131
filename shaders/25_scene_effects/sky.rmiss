#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"

#ifdef EFFECT_ENVIRONMENT
#include "common/sky_map.glsl"
#endif

layout(location = 0) rayPayloadInEXT Hit hit;

// The ray hit nothing: it sees the sky.
void main() {
    hit.t = -1.0;
    hit.color = push.world.sky * sky(gl_WorldRayDirectionEXT);
#ifdef EFFECT_ENVIRONMENT
    if (push.world.sky_on != 0) {
        Texel texel = texel_at(push.sky, push.world.rotation, gl_WorldRayDirectionEXT);
        hit.color = texel.radiance;
        hit.position.x = texel.density;
    }
#endif
}
