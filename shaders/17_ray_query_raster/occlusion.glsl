// The part of the sky that a surface sees. Ambient light comes from there, so whatever is in its way darkens it.
#include "common/disk.glsl"
#include "common/hit.glsl"
#include "common/lighting.glsl"

const uint DIMENSION_OCCLUSION = 2;

// The part of the sky that is open, each direction weighted by its cosine: 0 to 1. Points on the unit disk,
// lifted to the hemisphere above it, are spread by just that weight (Malley's method), so each ray counts
// alike. `first` are two random numbers.
float openness(RayOrigin start, vec3 normal, uint count, vec2 first) {
    vec3 aside = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 right = normalize(cross(aside, normal));
    vec3 ahead = cross(normal, right);
    uint open = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = disk_point(i, count, first);
        float height = sqrt(max(1.0 - dot(point, point), 0.0));
        vec3 direction = point.x * right + point.y * ahead + height * normal;
        // The surface itself hides all directions below it; they need no ray.
        if (dot(start.up, direction) > 0.0 && is_lit(start.origin, direction, 1e30)) {
            open++;
        }
    }
    return float(open) / float(max(count, 1));
}
