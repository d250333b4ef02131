// Light from a picture of the sky: shadow rays sample it, and paths meet it at random (chapter 46).
#include "common/sky_map.glsl"

// The purposes of random numbers: to choose a texel, and a direction in it.
const uint DIMENSION_TEXEL = 9;
const uint DIMENSION_WITHIN = 10;

#ifdef FOUND_TWICE
// A path has met the sky. What part of its light is counted here: the rest is that of shadow rays. What no shadow
// ray could have found is counted as a whole.
float part_of_sky(Path path, Hit miss) {
    if (push.world.sky_on == 0 || path.density == NO_OTHER) {
        return 1.0;
    }
    return path.density / max(path.density + miss.position.x, 1e-30);
}
#endif

// The shadow ray to a texel of the sky, likewise.
Sought to_sky(Path path, Hit hit, Scatterer by) {
    Sought sought = nothing_sought();
    if (push.world.sky_on == 0 || hit.color == vec3(0.0)) {
        return sought;
    }
    SkySample found = sky_sample(push.sky, push.world.rotation, numbers(path, DIMENSION_TEXEL),
        numbers(path, DIMENSION_WITHIN));
    if (largest(found.radiance) <= 0.0) {
        return sought;
    }
    vec3 part = sent_on(by, hit, found.direction, 1.0, found.density);
    return Sought(found.direction, FAR, part * found.radiance);
}
