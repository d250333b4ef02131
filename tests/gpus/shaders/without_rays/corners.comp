#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "common/scene.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;
layout(set = 0, binding = 1, scalar) buffer Corners { uint written[]; };
layout(set = 1, binding = 0) uniform sampler2D textures[];

struct Band {
    uvec2 first;
    uvec2 size;
};

layout(push_constant, scalar) uniform Push {
    SceneAddresses scene;
    Band band;
} push;

// A column for each primitive of the first instance, a row for each corner: where it is, and a texel's alpha.
void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.band.size))) return;
    uvec2 at = push.band.first + gl_GlobalInvocationID.xy;
    InstanceRecord instance = push.scene.instances.at[0];
    uint triangle = instance.original.at[at.x];
    vec3 corner = instance.vertices.at[instance.triangles.at[triangle][at.y]].position;
    uint first = at.y / 3u;     // 0, as is not known before it runs
    float alpha = texelFetch(textures[nonuniformEXT(first)], ivec2(0), 0).a;
    imageStore(picture, ivec2(at), vec4(corner, alpha));
    atomicAdd(written[at.y], 1u);
}
