#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/start.glsl"
#include "lighting.glsl"
#include "common/board.glsl"

// Above the ground or below it: where a ray comes from.
float side;

// ANCHOR: start
// `met.position` has the height that a march will find below it, to the bit: by the same function, of
// the same x and z. What a march computes is off by the ground's error, wherever in the box. So
// above twice that, only ground that is truly above the ray's own can be hit.
Start start_from(Met met, vec3 direction) {
    float lift = met.on_plane ? 0.0 : 2.0 * side * push.world.ground.error;
    return Start(met.position + vec3(0.0, lift, 0.0), 0.0);
}
// ANCHOR_END: start

// ANCHOR: color
// Fields, but for rock where the ground is steep or seen from below. The footprint of the pixel on the
// slope is looked at from above, where the fields are squares.
vec3 color(vec2 p, vec3 normal, float light) {
    Ground ground = push.world.ground;
    float slope = side < 0.0 ? 0.0 : normal.y;
    return mix(ground.rock, mix(ground.dark, ground.light, light), smoothstep(0.55, 0.8, slope));
}

float field(vec2 p, vec3 normal) {
    uint checker = push.world.ground.checker;
    float width = payload.width + payload.spread * gl_HitTEXT;
    vec2 box = footprint(
        width, gl_WorldRayDirectionEXT, normal, vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    box = checker == CHECKER_FILTERED ? box : vec2(0.0);
    return checker == CHECKER_OFF ? 1.0 : checker_light(p, box);
}
// ANCHOR_END: color

// The nearest hit is the ground.
void main() {
    if (PLANE_TEST == PLANE_AFTER && payload.plane <= gl_HitTEXT) {
        shade_plane();
        return;
    }
    // ANCHOR: met
    Ground ground = push.world.ground;
    precise vec3 point = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
    vec3 up = heightfield_normal(ground.shape, point.xz);
    // A ray falls on the ground, or it comes up from below.
    side = dot(up, gl_WorldRayDirectionEXT) > 0.0 ? -1.0 : 1.0;
    Met met;
    met.t = gl_HitTEXT;
    met.position = vec3(point.x, heightfield_height(ground.shape, point.xz), point.z);
    met.normal = side * up;
    met.flat_normal = met.normal;
    met.lift = vec3(0.0);
    met.up = met.normal;
    met.on_plane = false;
    // ANCHOR_END: met
    met.curvature = 0.0;
    float light = field(point.xz, up);
    met.material.base_color = color(point.xz, up, light);
    met.material.specular = vec3(0.0);
    met.material.shininess = 1.0;
    met.material.emission = vec3(0.0);
    met.reflection = vec3(ground.reflection);
    shade(met, vec4(-3.0, light, gl_HitTEXT, side < 0.0 ? 1.0 : 0.0), vec3(light));
}
