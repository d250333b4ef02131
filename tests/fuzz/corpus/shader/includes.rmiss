#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
layout(location = 0) rayPayloadInEXT vec4 color;
#include "a.glsl"
#include "b.glsl"
void main() { color = vec4(a(1.0)); }
