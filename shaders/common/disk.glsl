// Taught by 35_soft_shadows.
//
// A light with a size: a disk that shines, and points of it.
#include "common/light.glsl"

struct DiskLight {
    Light light;     // its middle
    float radius;    // 0 for a point
    uint samples;    // shadow rays per hit, if the radius is not 0
};

// Point i of n on the unit disk: a sunflower's spiral, started by two random numbers. Each point alone
// is uniform on the disk, and all together leave no gaps (Vogel 1979).
vec2 disk_point(uint i, uint n, vec2 start) {
    float radius = sqrt((float(i) + start.x) / float(n));
    // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
    float angle = 6.283185 * (fract(0.618033989 * float(i) + start.y + 0.5) - 0.5);
    return radius * vec2(cos(angle), sin(angle));
}

// From a point to a point of the disk, which faces it.
vec3 towards_disk(DiskLight disk, vec3 from, vec2 on_disk) {
    vec3 axis = towards_light(disk.light, from);
    if (disk.radius == 0.0) {
        return axis;
    }
    vec3 aside = abs(axis.y) < 0.9 * length(axis) ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 right = normalize(cross(aside, axis));
    vec3 up = normalize(cross(axis, right));
    return axis + disk.radius * (on_disk.x * right + on_disk.y * up);
}
