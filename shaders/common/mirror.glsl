// Taught by 06_reflection.
//
// Reflection by a mirror: its direction and its strength.

// From this number on, an MTL file's illumination model reflects (`illum 3`).
const uint ILLUMINATION_MIRROR = 3;

// The part of the light that a polished surface reflects: `head_on` when seen straight, and all of it
// at a grazing angle (Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994).
vec3 fresnel(vec3 head_on, float cosine) {
    float grazing = 1.0 - cosine;
    return head_on + (1.0 - head_on) * (grazing * grazing * grazing * grazing * grazing);
}

// Where a mirror sends a ray. Interpolated normals may send it into the triangle: it comes out again,
// mirrored at the triangle itself.
vec3 mirrored(vec3 direction, vec3 normal, vec3 up) {
    vec3 on = reflect(direction, normal);
    return normalize(on - 2.0 * min(dot(on, up), 0.0) * up);
}
