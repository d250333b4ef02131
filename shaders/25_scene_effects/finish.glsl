// The finish of a material that an MTL file cannot hold: a pattern (chapter 13), and lines (chapter 20).

// The finish of a material. Ground and plane have none, and in many scenes nothing has.
Finish finish_of(uint material) {
    Finish finish;
    finish.lines = 0.0;
    finish.pattern = 0;
    if (material < push.world.finish_count) {
        finish = push.world.finishes.at[material];
    }
    return finish;
}

#ifdef EFFECT_PATTERNS
#include "common/pattern.glsl"

// ANCHOR: pattern
// True if the pattern is of a kind. The compiler drops kinds that no material in use has.
bool is_of(uint pattern, uint kind) {
    return pattern == kind && (PATTERNS >> kind & 1) != 0;
}

// The weight of the second colour at a place, 0 to 1.
float second_at(uint pattern, vec3 place) {
    if (is_of(pattern, PATTERN_MARBLE)) {
        return marble(place, 0);
    }
    if (is_of(pattern, PATTERN_WOOD)) {
        return wood(place, 0);
    }
    return is_of(pattern, PATTERN_CHECKER) ? checker(place, 0) : 0.0;
}
// ANCHOR_END: pattern
#endif

// The colour of what was met: that of its finish, if it has one.
vec3 finished(Hit hit) {
    if (hit.material >= push.world.finish_count) {
        return hit.color;
    }
    Finish finish = push.world.finishes.at[hit.material];
    vec3 color = hit.color;
#ifdef EFFECT_PATTERNS
    if (finish.pattern != PATTERN_PLAIN) {
        vec3 first = push.scene.materials.at[hit.material].base_color;
        color = first + second_at(finish.pattern, finish.scale * hit.color) * (finish.second - first);
    }
#endif
#ifdef EFFECT_WIREFRAME
    color += hit.cone.x * (finish.ink - color);
#endif
    return color;
}
