// The material's data holds the number of its pattern. Here the number selects code, in one of two ways.
#include "common/pattern.glsl"
#include "finish.glsl"

// ANCHOR: caller
layout(location = 0) callableDataEXT Pattern pattern;
// ANCHOR_END: caller

// The weight of a pattern at a place.
float weight_at(uint kind, vec3 place, int far) {
    if (CHOOSE == CHOOSE_CALLABLE) {
        pattern.place = place;
        pattern.far = far;
        executeCallableEXT(kind - 1, 0);   // sbtRecordIndex, callable data location
        return pattern.weight;
    }
    switch (kind) {
        case PATTERN_MARBLE: return marble(place, far);
        case PATTERN_WOOD: return wood(place, far);
        default: return checker(place, far);
    }
}

// The hit's colour becomes that of its material's pattern.
void patterned(inout PatternHit seen) {
    Finish finish = push.finishes.at[seen.hit.material];
    if (finish.pattern != PATTERN_PLAIN) {
        mix_colors(seen, finish, weight_at(finish.pattern, finish.scale * seen.object, int(push.far)));
    }
}
