#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
layout(location = 0) rayPayloadInEXT vec4 color;
#line 3 "a[31mb"
float
void main() { }
