#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/hit.glsl"
#include "common/lighting.glsl"
#include "common/views.glsl"
#include "report.glsl"

layout(local_size_x_id = 3, local_size_y_id = 4) in;

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D picture;

bool is_lit(vec3 origin, vec3 to_light, float end) {
    rayQueryEXT query;
    rayQueryInitializeEXT(
        query,
        tlas,
        gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsOpaqueEXT,
        0xff,                       // cull mask: every instance
        origin,
        0.0,                        // tmin: the origin lies off the surface
        to_light,
        end                         // tmax
    );
    while (rayQueryProceedEXT(query)) {}
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}

// The nearest hit of a ray, or the sky.
Hit trace(vec3 origin, vec3 direction) {
    rayQueryEXT query;
    rayQueryInitializeEXT(
        query,
        tlas,
        gl_RayFlagsOpaqueEXT,       // no candidate is left to this shader
        0xff,                       // cull mask: every instance
        origin,
        0.0,                        // tmin
        direction,
        1e30                        // tmax
    );
    while (rayQueryProceedEXT(query)) {}
    Hit hit;
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
        report(hit, query);
    } else {
        hit.t = -1.0;
        hit.color = sky(direction);
    }
    return hit;
}

// One ray per pixel, through its middle; and from what it meets, one to the light.
void main() {
    // ANCHOR: band
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.band.size))) {
        return;    // the last workgroups reach beyond the band
    }
    uvec2 id = push.band.first + at;
    // ANCHOR_END: band
    vec2 point = vec2(id) + 0.5;
    vec3 direction = ray_direction(push.camera, point, imageSize(picture));
    Hit hit = trace(push.camera.origin, direction);
    vec3 color = hit.color;
    RayOrigin start = shadow_start(hit);
    float visible = 1.0;
    if (hit.t >= 0.0) {
        MaterialRecord material = push.scene.materials.at[hit.material];
        visible = visibility(start, push.light.direction, 1e30);
        color = material.emission + hit.color * ambient(hit.normal)
            + lit_by(visible * push.light.radiance, push.light.direction, hit, material, -direction);
    }
    vec4 pixel = SHOW == SHOW_PICTURE ? vec4(color, 1.0) : view_of(hit, direction, start.origin, visible);
    imageStore(picture, ivec2(id), pixel);
}
