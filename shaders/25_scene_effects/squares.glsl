// Squares on a surface, averaged over what a pixel sees of them (chapter 43).
#include "common/checker.glsl"
#include "ray.glsl"

// The width of the cone of a pixel's rays on a surface, along two of its axes, at distance t.
vec2 footprint(Ray ray, float t, vec3 normal, vec3 u, vec3 v) {
    vec3 direction = ray.direction;
    float width = ray.width + ray.spread * t;
    vec3 along = direction - dot(direction, normal) * normal;
    float length_along = length(along);
    along = length_along > 0.0 ? along / length_along : u;
    vec3 across = cross(normal, along);
    float slant = max(abs(dot(direction, normal)) / length(direction), 1e-30);
    return width * vec2(length(vec2(dot(along, u) / slant, dot(across, u))),
                        length(vec2(dot(along, v) / slant, dot(across, v))));
}
