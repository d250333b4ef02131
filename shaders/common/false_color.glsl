// Of no chapter: what views are painted with.
//
// A colour that differs from number to number (the finaliser of a 32-bit murmur hash).
vec3 false_color(uint number) {
    number = (number ^ (number >> 16)) * 0x85ebca6bu;
    number = (number ^ (number >> 13)) * 0xc2b2ae35u;
    number ^= number >> 16;
    return vec3(number & 0xffu, (number >> 8) & 0xffu, (number >> 16) & 0xffu) / 255.0;
}
