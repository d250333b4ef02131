// The light that a shadow ray finds, weighted in case a path finds the same light at random.

struct Scatterer {
    float matte;            // the probability that a matte surface scatters the next ray
#ifdef EFFECT_ROUGH_METAL
    Microfacets surface;    // with a roughness below 0 if it has none
    float continues;        // 1 if the path goes on from microfacets; else 0
#endif
};

#ifdef SAMPLED_LIGHT
// The density of `kept_above(cosine_direction(u, normal), up)`: of a direction, and of the one that is
// mirrored to it.
float likelihood(vec3 direction, vec3 normal, vec3 up) {
    float above = dot(direction, up);
    vec3 other = direction - 2.0 * above * up;
    float both = max(dot(direction, normal), 0.0) + max(dot(other, normal), 0.0);
    return above > 0.0 ? both / 3.14159265 : 0.0;
}

// The part of the light from a direction that goes to the eye. The shadow ray stands for the solid angle `angle`
// in one of `1 / probability` cases. The path may also find that light: the balance heuristic weights both.
vec3 sent_on(Scatterer by, Hit hit, vec3 direction, float angle, float probability) {
#ifdef EFFECT_ROUGH_METAL
    if (by.surface.roughness >= 0.0) {
        float above = dot(direction, hit.face);
        if (above <= 0.0) {
            return vec3(0.0);
        }
        // A path arrives at a direction by itself, or mirrored at the triangle: `kept_above`.
        vec3 other = direction - 2.0 * above * hit.face;
        mat3 frame = frame_of(hit.normal);
        float density = probability / max(angle, 1e-30);
        return hit.color * (balanced(by.surface, direction * frame, density, by.continues)
            + balanced(by.surface, other * frame, density, by.continues));
    }
#endif
    float chance = likelihood(direction, hit.normal, hit.face) * angle;
    return chance / (probability + by.matte * chance) * hit.color;
}
#endif
