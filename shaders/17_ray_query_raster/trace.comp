#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/hit.glsl"
#include "common/lighting.glsl"
#include "occlusion.glsl"
#include "report.glsl"

layout(local_size_x_id = 3, local_size_y_id = 4) in;

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D picture;
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2D gbuffer;

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

// ANCHOR: primary
// The surface that the rasteriser has drawn in a pixel.
Seen by_raster(uvec2 pixel) {
    uvec4 texel = imageLoad(gbuffer, ivec2(pixel));
    return Seen(texel.x, texel.y, uintBitsToFloat(texel.zw));
}

// The surface that a ray query finds, as in 16.
Seen by_ray(vec3 origin, vec3 direction) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, tlas, gl_RayFlagsOpaqueEXT, 0xff, origin, 0.0, direction, 1e30);
    while (rayQueryProceedEXT(query)) {}
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) {
        return Seen(NOTHING, 0, vec2(0.0));
    }
    uint number = rayQueryGetIntersectionInstanceCustomIndexEXT(query, true);
    uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, true);
    uint triangle = push.scene.instances.at[number].original.at[primitive];
    return Seen(number, triangle, rayQueryGetIntersectionBarycentricsEXT(query, true));
}
// ANCHOR_END: primary

// The quantity a view shows of a hit, instead of the picture.
vec4 view_of(Hit hit, Seen seen, vec3 direction, float visible, float open) {
    bool missed = hit.t < 0.0;
    switch (SHOW) {
        case SHOW_TRIANGLE: return vec4(missed ? hit.color : false_color(hit.triangle), 1.0);
        case SHOW_WEIGHTS:
            return vec4(missed ? hit.color
                : vec3(seen.barycentrics, 1.0 - seen.barycentrics.x - seen.barycentrics.y), 1.0);
        case SHOW_HIT: return missed ? vec4(-1.0) : vec4(hit.instance, hit.triangle, hit.t, hit.material);
        case SHOW_DIRECTION: return vec4(direction, hit.t);
        case SHOW_SHADOW: return vec4(missed ? hit.color : vec3(visible), 1.0);
        default: return vec4(missed ? hit.color : vec3(open), 1.0);
    }
}

// One surface a pixel; and from it, a ray to the light and rays to the sky.
void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.band.size))) {
        return;    // the last workgroups reach beyond the band
    }
    uvec2 id = push.band.first + at;
    vec2 point = vec2(id) + 0.5;
    vec3 direction = ray_direction(push.camera, point, imageSize(picture));
    // ANCHOR: surface
    Seen seen = PRIMARY == PRIMARY_RASTER ? by_raster(id) : by_ray(push.camera.origin, direction);
    Hit hit;
    hit.t = -1.0;
    hit.color = sky(direction);
    vec3 color = hit.color;
    float visible = 1.0;
    float open = 1.0;
    if (seen.instance != NOTHING) {
        report(hit, seen, direction);
        RayOrigin start = shadow_start(hit);
        // ANCHOR_END: surface
        MaterialRecord material = push.scene.materials.at[hit.material];
        visible = visibility(start, push.light.direction, 1e30);
        if (push.occlusion_rays > 0) {
            vec2 first = random(id, 0, 0, DIMENSION_OCCLUSION).xy;
            open = openness(start, hit.normal, push.occlusion_rays, first);
        }
        color = material.emission + open * hit.color * ambient(hit.normal)
            + lit_by(visible * push.light.radiance, push.light.direction, hit, material, -direction);
    }
    vec4 pixel = SHOW == SHOW_PICTURE ? vec4(color, 1.0) : view_of(hit, seen, direction, visible, open);
    imageStore(picture, ivec2(id), pixel);
}
