// The colour of the ground: fields, and rock where it is steep.
#include "ray.glsl"
#include "squares.glsl"

// A field is as sharp as the cone of the ray is narrow there: so the raygen shader has to paint it.
vec3 ground_color(Ray ray, Hit hit) {
    Ground ground = push.world.ground;
    vec2 width = footprint(ray, hit.t, hit.normal, vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    float light = checker_light(hit.position.xz / ground.square, width / ground.square);
    vec3 fields = mix(ground.dark, ground.light, light);
    return mix(ground.rock, fields, smoothstep(0.6, 0.85, hit.normal.y));
}
