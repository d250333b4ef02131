#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "atlas.glsl"

layout(location = 0) rayPayloadInEXT Found payload;
hitAttributeEXT vec2 barycentrics;

// Only opaque hits come here.
void main() {
    payload.nearest = Met(gl_PrimitiveID, gl_HitTEXT, barycentrics);
}
