// The choice of the emitter that a shadow ray samples.

// ANCHOR: choice
struct Choice {
    uint emitter;
    float probability;
};

// The number of shadow rays to emitters at a hit.
uint choices() {
    return CHOICE == CHOICE_ALL ? push.emitters.count : min(push.emitters.count, 1);
}

// The probability that a given emitter is chosen at a hit.
float probability_of(uint index) {
    if (CHOICE == CHOICE_POWER) {
        return push.emitters.emitters.at[index].probability;
    }
    return CHOICE == CHOICE_ALL ? 1.0 : 1.0 / float(push.emitters.count);
}

// The emitter of shadow ray `i`, chosen by `u`.
Choice choice(uint i, vec2 u) {
    uint index = i;
    if (CHOICE == CHOICE_ONE) {
        index = min(uint(u.x * float(push.emitters.count)), push.emitters.count - 1);
    } else if (CHOICE == CHOICE_POWER) {
        // Both numbers are multiples of 2^-24, and there are 2^k columns: so nothing here is rounded.
        uint column = uint(u.x * float(push.emitters.column_count));
        Column found = push.emitters.columns.at[column];
        index = u.y < found.own ? column : found.other;
    }
    return Choice(index, probability_of(index));
}
// ANCHOR_END: choice
