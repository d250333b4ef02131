// The weight by which one pixel's light also counts for another, as far as their surfaces go.

// A camera, as far as the filter needs it.
struct Eye {
    vec3 origin;
    float apart;      // the distance between the rays of two neighbours, at distance 1
};

// The distance from the other's plane is compared with the distance of the pixels' rays, and the cosine between
// the normals is raised to the power of 16. (Schied and others 2017 take 128, for larger pictures, where neighbours
// on a round piece differ less.) The weight is the same if the two change places, to the bit.
float alike(Eye eye, Seen a, Seen b, float pixels) {
    if (instance_of(a) == NOTHING || instance_of(b) == NOTHING) {
        return 0.0;
    }
    vec3 normal_a = unpacked(a.normal);
    vec3 normal_b = unpacked(b.normal);
    vec3 between = b.position - a.position;
    float off = abs(dot(normal_a, between)) + abs(dot(normal_b, between));
    float distance = 0.5 * (length(a.position - eye.origin) + length(b.position - eye.origin));
    float cosine = max(dot(normal_a, normal_b), 0.0);
    for (uint i = 0; i < 4; i++) {
        cosine *= cosine;
    }
    return exp(-off / (pixels * eye.apart * distance)) * cosine;
}
