#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "placed.glsl"

layout(push_constant, scalar) uniform Draw {
    CameraBasis camera;
    SceneAddresses scene;
    Placements placed;
    float near;           // nothing nearer to the eye is drawn
} draw;

layout(constant_id = 0) const uint DEPTH = 0;
const uint DEPTH_REVERSED = 0;
const uint DEPTH_USUAL = 1;
const uint DEPTH_SHORT = 2;

layout(location = 0) flat out uint instance;
layout(location = 1) flat out uint triangle;
layout(location = 2) out vec2 barycentrics;

// One corner of a triangle, by the records that a hit shader reads. A draw call is for one instance.
void main() {
    instance = gl_InstanceIndex;
    triangle = gl_VertexIndex / 3;
    uint corner = gl_VertexIndex % 3;
    InstanceRecord record = draw.scene.instances.at[instance];
    vec3 position = record.vertices.at[record.triangles.at[triangle][corner]].position;
    // The second and the third barycentric coordinate, as a ray reports them.
    barycentrics = vec2(corner == 1, corner == 2);

    // The inverse of ray_direction: along which ray of the camera does the corner lie, and how far?
    vec3 world = draw.placed.at[instance].to_world * vec4(position, 1.0);
    vec3 way = world - draw.camera.origin;
    float x = dot(way, draw.camera.right) / dot(draw.camera.right, draw.camera.right);
    float y = dot(way, draw.camera.up) / dot(draw.camera.up, draw.camera.up);
    float distance = dot(way, draw.camera.forward);
    // Divided by the distance: 1 at the near plane and 0 at infinity, or the reverse.
    float depth = DEPTH == DEPTH_REVERSED ? draw.near : distance - draw.near;
    gl_Position = vec4(x, -y, depth, distance);
}
