#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"

layout(location = 0) rayPayloadInEXT Path payload;

#include "fog.glsl"

// The ray hit nothing: it sees the sky.
void main() {
    float clear = clear_after(way_outside(FAR));
    vec4 seen = vec4(mix(push.world.fog.color, sky(gl_WorldRayDirectionEXT), clear), 1.0);
    if (push.show == SHOW_HIT) {
        seen = vec4(-1.0);
    }
    if (push.show == SHOW_DIRECTION) {
        seen = vec4(gl_WorldRayDirectionEXT, -1.0);
    }
    if (push.show == SHOW_SHADOW_ORIGIN) {
        seen = vec4(-1.0);
    }
    if (push.show == SHOW_RAY_ORIGIN) {
        seen = vec4(gl_WorldRayOriginEXT, gl_RayTminEXT);
    }
    if (push.show == SHOW_FOG) {
        seen = vec4(way_outside(FAR), clear, -1.0, 1.0);
    }
    gather(payload, seen);
    // Nothing lies beyond the sky.
    payload.throughput = vec3(0.0);
}
