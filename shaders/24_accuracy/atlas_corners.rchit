#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#extension GL_EXT_ray_tracing_position_fetch : require
#include "atlas.glsl"

layout(location = 0) rayPayloadInEXT Found payload;

// The corners of the triangle, as the acceleration structure has them.
void main() {
    uint first = 3 * ray_number();
    for (uint k = 0; k < 3; k++) {
        push.fetched.at[first + k] = gl_HitTriangleVertexPositionsEXT[k];
    }
    payload.nearest = Met(gl_PrimitiveID, gl_HitTEXT, vec2(0.0));
}
