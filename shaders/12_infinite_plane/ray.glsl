// A ray, and the cone around it: all that a pixel sees by it.

struct Ray {
    vec3 origin;
    vec3 direction;
    float width;     // of the cone, where the ray begins
    float spread;    // by how much that widens in a unit of length
};
