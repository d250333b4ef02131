#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_NV_ray_tracing_motion_blur : require

layout(location = 0) rayPayloadInEXT vec3 normal;

// The normals of the vertex that was hit, when the shutter opens and when it closes.
layout(push_constant) uniform Push {
    vec3 open;
    vec3 close;
} push;

// The device moves positions alone: what else a vertex has is mixed here.
void main() {
    normal = normalize(mix(push.open, push.close, gl_CurrentRayTimeNV));
}
