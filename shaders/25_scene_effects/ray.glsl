// A ray, and the cone around it: all that a pixel sees by it.

struct Ray {
    vec3 origin;
    vec3 direction;
#ifdef EFFECT_PLANE
    bool on_plane;   // it leaves the plane
#endif
#ifdef CONES
    float width;     // of the cone, where the ray begins
    float spread;    // by how much that widens in a unit of length
#endif
};
