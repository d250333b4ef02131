// Taught by 35_soft_shadows.
//
// The part of a shining disk that a surface sees.
#include "common/lighting.glsl"
#include "common/disk.glsl"

// From 0 to 1. One ray is enough if the disk is a point. Otherwise several rays go to points of it, which start
// at the random numbers `first`.
float visible_part(DiskLight disk, RayOrigin start, vec2 first) {
    bool soft = disk.radius > 0.0;
    uint count = soft ? disk.samples : 1;
    float seen = 0.0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, first) : vec2(0.0);
        seen += visibility(start, towards_disk(disk, start.origin, point), light_end(disk.light));
    }
    return seen / float(count);
}
