// Taught by 26_leaving_a_surface.

// Where a ray starts.
struct RayOrigin {
    vec3 origin;
    float tmin;      // a length, however long the direction is
};
