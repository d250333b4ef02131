// Taught by 45_rough_metal.
//
// The light that the facets reflect in all, from a table: the directional albedo.
#include "rough.glsl"

// ANCHOR: albedo
// The table has as many rows, for roughness, as columns, for the angle.
const uint ALBEDO_STEPS = 32;

float fifth_power(float cosine) {
    float grazing = 1.0 - cosine;
    return grazing * grazing * grazing * grazing * grazing;
}

// The light that facets reflect which reflect `head_on` head-on.
vec3 reflected(vec3 head_on, Albedo albedo, float cosine) {
    return head_on * (1.0 - albedo.lost) + (1.0 - head_on) * (fifth_power(cosine) + albedo.more);
}

// The mean over all directions, weighted by their cosine: that of the fifth power is 1/21.
vec3 mean_reflected(vec3 head_on, Albedo mean) {
    return head_on * (1.0 - mean.lost) + (1.0 - head_on) * (1.0 / 21.0 + mean.more);
}
// ANCHOR_END: albedo

Albedo between(Albedo a, Albedo b, float part) {
    return Albedo(mix(a.lost, b.lost, part), mix(a.more, b.more, part));
}

// ANCHOR: lookup
// Rough surfaces lose light at all angles, smooth ones only at angles as low as alpha: so the columns are evenly
// spaced in cosine / (cosine + alpha).
Albedo albedo(RoughAddresses rough, float alpha, float roughness, float cosine) {
    if (alpha == 0.0) {
        return Albedo(0.0, 0.0);
    }
    vec2 at = float(ALBEDO_STEPS - 1) * vec2(cosine * (1.0 + alpha) / (cosine + alpha), roughness);
    uvec2 cell = min(uvec2(at), ALBEDO_STEPS - 2);
    vec2 part = at - vec2(cell);
    uint first = cell.y * ALBEDO_STEPS + cell.x;
    Albedo row = between(rough.albedos.at[first], rough.albedos.at[first + 1], part.x);
    Albedo next = between(rough.albedos.at[first + ALBEDO_STEPS], rough.albedos.at[first + ALBEDO_STEPS + 1], part.x);
    return between(row, next, part.y);
}
// ANCHOR_END: lookup

// The mean over all directions.
Albedo mean_albedo(RoughAddresses rough, float alpha, float roughness) {
    if (alpha == 0.0) {
        return Albedo(0.0, 0.0);
    }
    float at = float(ALBEDO_STEPS - 1) * roughness;
    uint cell = min(uint(at), ALBEDO_STEPS - 2);
    Albedo mean = between(rough.means.at[cell], rough.means.at[cell + 1], at - float(cell));
    // The table has what is lost relative to alpha, which changes little from row to row.
    return Albedo(mean.lost * alpha, mean.more);
}

// ANCHOR: again
// The part of the light lost at the first facet that leaves a metal after two or more: each facet takes its share,
// and passes on to the next what does not get out (Kulla and Conty 2017; the square is Hill's, 2018).
vec3 reflected_again(vec3 color, Albedo mean) {
    vec3 facet = color + (1.0 - color) / 21.0;
    return facet * facet * (1.0 - mean.lost) / (1.0 - facet * mean.lost);
}
// ANCHOR_END: again
