// What a material has beside what an MTL file can say: a pattern (chapter 13), and lines (chapter 20).
#ifdef EFFECT_PATTERNS
#include "common/pattern.glsl"

// ANCHOR: pattern
// Whether a finish has this pattern. What no material in use has, the compiler drops.
bool has_pattern(Finish finish, uint pattern) {
    return finish.pattern == pattern && (PATTERNS >> pattern & 1) != 0;
}

// How much of the second colour there is at a place, 0 to 1.
float second_at(Finish finish, vec3 place) {
    if (has_pattern(finish, PATTERN_MARBLE)) {
        return marble(place, 0);
    }
    if (has_pattern(finish, PATTERN_WOOD)) {
        return wood(place, 0);
    }
    if (has_pattern(finish, PATTERN_CHECKER)) {
        return checker(place, 0);
    }
    return 0.0;
}
// ANCHOR_END: pattern
#endif

// The colour of what was met becomes that of its finish. Ground and plane have none.
void apply_finish(inout Hit hit) {
    if (hit.material >= push.world.finish_count) {
        return;
    }
    Finish finish = push.world.finishes.at[hit.material];
#ifdef EFFECT_PATTERNS
    hit.color += second_at(finish, finish.scale * hit.object) * (finish.second - hit.color);
#endif
#ifdef EFFECT_WIREFRAME
    hit.color += hit.line.x * (finish.ink - hit.color);
#endif
}
