// Taught by 27_glass.
//
// The media that a ray is in: bodies may overlap, and one of them counts.

// No body at all.
const uint AIR = 0xffffffffu;

// ANCHOR: media
// Up to four bodies, each by the number of its material. The lowest comes first and counts (Schmidt and
// Budge, "Simple Nested Dielectrics in Ray Traced Images", JGT 7:2, 2002). The rest is air.

// The media of a ray that enters a body.
uvec4 entered(uvec4 media, uint material) {
    return min(media, max(uvec4(0, media.xyz), material));
}

// The media of a ray that leaves a body. Leaving one that it was not in changes nothing.
uvec4 left(uvec4 media, uint material) {
    uvec4 without = mix(media, uvec4(media.yzw, AIR), greaterThanEqual(media, uvec4(material)));
    return any(equal(media, uvec4(material))) ? without : media;
}
// ANCHOR_END: media
