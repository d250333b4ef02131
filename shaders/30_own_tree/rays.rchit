#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "constants.glsl"
#include "rays.glsl"

layout(location = 0) rayPayloadInEXT Answer answer;

void main() {
    answer = Answer(gl_HitTEXT, gl_InstanceCustomIndexEXT, gl_PrimitiveID, 0);
}
