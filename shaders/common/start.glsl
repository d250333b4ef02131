// Taught by 26_leaving_a_surface; what 24 has of it: where a ray starts.

struct Start {
    vec3 origin;
    float tmin;      // a length, however long the direction is
};
