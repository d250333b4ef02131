// Of no chapter: axes across a normal, for those whose light is computed in the frame of a surface.

// The frame of a normal, which is its third axis (Duff et al., JCGT 6:1, 2017).
mat3 frame_of(vec3 normal) {
    float side = normal.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    return mat3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x,
        b, side + normal.y * normal.y * a, -normal.y,
        normal);
}
