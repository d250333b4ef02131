#version 460
#extension GL_GOOGLE_include_directive : require

layout(location = 0) flat in uint instance;
layout(location = 1) flat in uint triangle;
layout(location = 2) in vec2 barycentrics;

layout(location = 0) out uvec4 seen;

// The surface that a pixel sees so far: the depth test decides whether it stays.
void main() {
    seen = uvec4(instance, triangle, floatBitsToUint(barycentrics));
}
