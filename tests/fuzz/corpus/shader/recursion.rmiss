#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
layout(location = 0) rayPayloadInEXT vec4 color;
float f(float x) { return f(x); }
void main() { color.x = f(1.0); }
