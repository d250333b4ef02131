// The pixels whose light is likely to suit another.

// ANCHOR: alike
// Normals at most 26 degrees apart, and a place near the other's plane, by a part of its distance to the eye. Any rule
// would do that looks at surfaces alone and not at samples.
bool alike(Receiver here, Receiver there, vec3 eye, float tolerance) {
    if (there.normal == NOTHING) {
        return false;
    }
    vec3 between = there.from - here.from;
    float off = abs(dot(unpacked(here.face), between));
    return dot(unpacked(here.normal), unpacked(there.normal)) > 0.9
        && off <= tolerance * length(here.from - eye);
}
// ANCHOR_END: alike
