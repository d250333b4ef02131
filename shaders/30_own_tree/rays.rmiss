#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "constants.glsl"
#include "rays.glsl"

layout(location = 0) rayPayloadInEXT Answer answer;

void main() {
    answer.instance = NOTHING;
}
