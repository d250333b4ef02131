#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "walk.glsl"
#include "views.glsl"
#include "report.glsl"
#include "common/lighting.glsl"
#include "common/views.glsl"

layout(local_size_x_id = 4, local_size_y_id = 5) in;

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;

bool is_lit(vec3 origin, vec3 to_light, float end) {
    return walk(push.trees.at[0], origin, to_light, end, true).placed == NOTHING;
}

// The nearest hit of a ray, or the sky.
Hit trace(vec3 origin, vec3 direction, out Met met) {
    met = walk(push.trees.at[0], origin, direction, 1e30, false);
    Hit hit;
    if (met.placed != NOTHING) {
        report(hit, met, origin, direction);
    } else {
        hit.t = -1.0;
        hit.color = sky(direction);
    }
    return hit;
}

// The quantity a view shows of a hit, instead of the picture.
vec4 view_of(Hit hit, Met met, vec3 direction, RayOrigin start, float visible) {
    bool missed = hit.t < 0.0;
    switch (SHOW) {
        case SHOW_STEPS: return vec4(heat(float(met.boxes + met.triangles) / 150.0), 1.0);
        case SHOW_DEPTH: return vec4(heat(missed ? 0.0 : float(depth_of(push.trees.at[0], met)) / 32.0), 1.0);
        case SHOW_BOXES:
        case SHOW_WALK: return vec4(edges_over(0.5 * hit.color, hit.t), 1.0);
        default: return view_of(hit, direction, start.origin, visible);
    }
}

// One ray per pixel, through its middle; and from what it meets, one to the light.
void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.band.size))) {
        return;    // the last workgroups reach beyond the band
    }
    uvec2 id = push.band.first + at;
    vec2 point = vec2(id) + 0.5;
    vec3 direction = ray_direction(push.camera, point, imageSize(picture));
    pixel_direction = direction;
    Met met;
    Hit hit = trace(push.camera.origin, direction, met);
    vec3 color = hit.color;
    RayOrigin start = shadow_start(hit);
    float visible = 1.0;
    float apart = 1.0;    // from the pixel of the one ray
    if (SHOW == SHOW_WALK) {
        // The boxes of this pixel's own walk are forgotten; those of the one ray count. It walks twice: to count its
        // nodes, and to draw as many of them as are asked for.
        vec2 size = vec2(imageSize(picture));
        vec2 aim = floor(push.view.pixel * size) + 0.5;
        vec3 one = ray_direction(push.camera, aim, uvec2(size));
        last = push.view.step;
        for (uint pass = 0; pass < 2; pass++) {
            edge_t = 1e30;
            visited = 0;
            last = min(last, walk(push.trees.at[0], push.camera.origin, one, 1e30, false).boxes);
        }
        apart = distance(point, aim) / size.y;
    }
    if (hit.t >= 0.0 && SHOW < SHOW_STEPS) {
        MaterialRecord material = push.scene.materials.at[hit.material];
        visible = visibility(start, push.light.direction, 1e30);
        color = material.emission + hit.color * ambient(hit.normal)
            + lit_by(visible * push.light.radiance, push.light.direction, hit, material, -direction);
    }
    vec4 pixel = SHOW == SHOW_PICTURE ? vec4(color, 1.0)
        : view_of(hit, met, direction, start, visible);
    if (apart < 0.01) {
        pixel.rgb = vec3(apart < 0.007 ? 1.0 : 0.0);
    }
    imageStore(picture, ivec2(id), pixel);
}
