#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "lighting.glsl"

// Above the ground or below it: where a ray comes from.
float side;

#ifdef DEPARTURES
// The height at the hit is the one that a march will find below it. What a march computes is off by the
// ground's error, so above twice that only ground can be hit that is truly higher.
Start start_from(Met met, vec3 direction) {
    return Start(met.position + vec3(0.0, 2.0 * side * push.world.ground.error, 0.0), 0.0);
}
#endif

// The nearest hit is the ground: fields, and rock where it is steep.
void main() {
    Ground ground = push.world.ground;
    precise vec3 point = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
    vec3 up = heightfield_normal(ground.shape, point.xz);
    side = dot(up, gl_WorldRayDirectionEXT) > 0.0 ? -1.0 : 1.0;
    vec2 width = footprint(
        gl_HitTEXT, gl_WorldRayDirectionEXT, up, vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    float light = checker_light(point.xz / ground.square, width / ground.square);

    Met met;
    met.t = gl_HitTEXT;
    met.position = vec3(point.x, heightfield_height(ground.shape, point.xz), point.z);
    met.normal = side * up;
    met.flat_normal = met.normal;
    met.lift = vec3(0.0);
    met.up = met.normal;
    met.on_plane = false;
    met.curvature = 0.0;
    vec3 fields = mix(ground.dark, ground.light, light);
    met.base_color = mix(ground.rock, fields, smoothstep(0.6, 0.85, side * up.y));
    met.specular = vec3(0.0);
    met.shininess = 1.0;
    met.emission = vec3(0.0);
    met.reflection = vec3(0.0);
    shade(met);
}
