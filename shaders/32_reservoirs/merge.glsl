// One reservoir from several, of this pixel and of others.

// A reservoir, and the receiver it was made for. Its count is 0 if it must not be used.
struct Source {
    Receiver receiver;
    Reservoir reservoir;
};

// Source 0 is the pixel's own. The includer says which the others are.
Source source(uint i);

// ANCHOR: balance
// The part of a sample that source `i` stands for, where any source could have made it: the balance heuristic of 29,
// with the target of each receiver in place of its density, which is unknown. Source 0 is known to see the sample.
float share(uint i, uint sources, Reservoir chosen) {
    float own = 0.0;
    float all = 0.0;
    for (uint j = 0; j < sources; j++) {
        Source from = source(j);
        if (from.reservoir.count == 0) {
            continue;
        }
        float there = float(from.reservoir.count) * target(from.receiver, chosen, j == 0 || j == i);
        all += there;
        own = j == i ? there : own;
    }
    return own > 0.0 ? own / all : 0.0;
}
// ANCHOR_END: balance

// ANCHOR: able
// The number of candidates of all sources that could have made a sample, as its maker could, and source 0.
uint able(uint maker, uint sources, Reservoir chosen) {
    uint count = 0;
    for (uint j = 0; j < sources; j++) {
        Source from = source(j);
        if (from.reservoir.count > 0 && target(from.receiver, chosen, j == 0 || j == maker) > 0.0) {
            count += from.reservoir.count;
        }
    }
    return count;
}
// ANCHOR_END: able

// ANCHOR: merge
// Keeps the sample of one source, in proportion to its target at source 0. With visibility, that is 0 in shadow: so a
// reservoir has samples that its receiver sees, and no others.
Reservoir merged(uvec2 pixel, uint purpose, uint sources) {
    Receiver receiver = source(0).receiver;
    Reservoir kept = EMPTY;
    float sum = 0.0;
    float chosen = 0.0;    // the target of the one that is kept
    uint maker = 0;        // its source
    for (uint i = 0; i < sources; i++) {
        Reservoir from = source(i).reservoir;
        kept.count += from.count;
        if (from.count == 0 || from.weight == 0.0) {
            continue;
        }
        float here = target(receiver, from, i == 0);
        if (here == 0.0) {
            continue;
        }
        float part = WEIGHTS == WEIGHTS_BALANCE ? share(i, sources, from) : float(from.count);
        uint bits = random_bits(pixel, push.sample_index, purpose, i, push.seed).x;
        if (replaces(sum, part * here * from.weight, bits)) {
            kept.emitter = from.emitter;
            kept.at = from.at;
            chosen = here;
            maker = i;
        }
    }
    if (chosen == 0.0) {
        return kept;
    }
    if (WEIGHTS == WEIGHTS_ONE_OVER_M) {
        chosen *= float(kept.count);
    } else if (WEIGHTS == WEIGHTS_ONE_OVER_Z) {
        chosen *= float(able(maker, sources, kept));
    }
    kept.weight = min(sum / chosen, 1e30);
    return kept;
}
// ANCHOR_END: merge
