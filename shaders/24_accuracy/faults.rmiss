#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "faults.glsl"

layout(location = 0) rayPayloadInEXT Seen seen;

void main() {
    seen.primitive = NOTHING;
}
