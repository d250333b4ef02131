#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "atlas.glsl"

layout(location = 0) rayPayloadInEXT Found payload;

// The ray goes nowhere: what was found before, or nothing, stays.
void main() {
}
