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

// The light of the sky that a surface sends on, sampled by a shadow ray.
vec3 from_sky(Path path, Hit hit, Scatterer by) {
    if (push.world.sky_on == 0 || hit.color == vec3(0.0)) {
        return vec3(0.0);
    }
    SkySample found = sky_sample(push.sky, push.world.rotation, numbers(path, DIMENSION_TEXEL),
        numbers(path, DIMENSION_WITHIN));
    if (largest(found.radiance) <= 0.0) {
        return vec3(0.0);
    }
    // The next ray starts at the same place, so that both see the same sky.
    vec3 from = hit.position + hit.offset * hit.face;
    vec3 part = sent_on(by, hit, found.direction, 1.0, found.density);
    if (part == vec3(0.0) || !is_lit(from, found.direction, FAR, hit.material == MATERIAL_PLANE)) {
        return vec3(0.0);
    }
    return part * found.radiance;
}
