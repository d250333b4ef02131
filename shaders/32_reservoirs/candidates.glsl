// The first reservoir of a pixel: one of many candidates.

// ANCHOR: candidates
// Candidates are emitters chosen by power, as in 29, and random points of them. One is kept, in proportion to the light
// it brings here: power and distance together.
Reservoir candidates(uvec2 pixel, Receiver receiver) {
    Reservoir kept = EMPTY;
    kept.count = push.candidates;
    float sum = 0.0;
    float chosen = 0.0;    // the target of the one that is kept
    for (uint i = 0; i < push.candidates; i++) {
        uvec4 bits = random_bits(pixel, push.sample_index, PURPOSE_CANDIDATE, i, push.seed);
        uint column = uint(to_unit(bits.x) * float(push.emitters.column_count));
        Column found = push.emitters.columns.at[column];
        uint emitter = to_unit(bits.y) < found.own ? column : found.other;
        float probability = push.emitters.emitters.at[emitter].probability;
        float here = brightness(arriving(receiver, emitter, bits.z));
        if (replaces(sum, here / probability, bits.w)) {
            kept.emitter = emitter;
            kept.at = bits.z;
            chosen = here;
        }
    }
    if (chosen > 0.0 && target(receiver, kept, false) > 0.0) {
        kept.weight = sum / (float(push.candidates) * chosen);
    }
    return kept;
}
// ANCHOR_END: candidates
