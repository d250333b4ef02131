// Light that shadow rays look for in one direction of many: that of emitters, and of a picture of the sky.

// A shadow ray, and the light that it finds if nothing is in the way.
struct Sought {
    vec3 to;
    float end;
    vec3 light;
};

Sought nothing_sought() {
    return Sought(vec3(0.0), 0.0, vec3(0.0));
}

#ifdef EFFECT_EMITTERS
#include "emitters.glsl"
#endif
#ifdef EFFECT_ENVIRONMENT
#include "environment.glsl"
#endif

// The kinds of light that are sampled: by the effects in use, one or both.
#ifdef EFFECT_EMITTERS
const uint FIRST_SAMPLED = 0;
#else
const uint FIRST_SAMPLED = 1;
#endif
#ifdef EFFECT_ENVIRONMENT
const uint LAST_SAMPLED = 1;
#else
const uint LAST_SAMPLED = 0;
#endif

// Adds the light of emitters and of the sky that a surface sends to the eye. In a loop, a compiler that inlines
// what a ray may call does so once.
void add_sampled(inout Path path, Hit hit, Scatterer by) {
    // The next ray starts at the same place, so that it sees the same light.
    vec3 from = hit.position + hit.offset * hit.face;
    for (uint kind = FIRST_SAMPLED; kind <= LAST_SAMPLED; kind++) {
        Sought sought = nothing_sought();
#ifdef EFFECT_EMITTERS
        if (kind == 0) {
            sought = to_emitter(path, hit, by, from);
        }
#endif
#ifdef EFFECT_ENVIRONMENT
        if (kind == 1) {
            sought = to_sky(path, hit, by);
        }
#endif
        if (sought.light != vec3(0.0) && is_lit(from, sought.to, sought.end, hit.material == MATERIAL_PLANE)) {
            path.color += sought.light;
        }
    }
}
