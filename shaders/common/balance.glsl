// Taught by 46_environment.
//
// Two ways to find the light of the sky, and what each of them counts.
//
// A path leaves a surface by a facet or by the rest, which are separate parts of the BRDF (45). So each part has a
// density of its own, and is balanced with shadow rays by itself (Veach and Guibas 1995).
#include "microfacet.glsl"

// ANCHOR: density
// The density of directions that `by_facet` mirrors the view to; `facet` is half way between the two.
float facet_density(Microfacets surface, vec3 facet) {
    float seen = bound_of(surface.alpha, surface.view) * surface.view.z + stretched(surface.alpha, surface.view.z);
    return 0.5 * distribution(surface.alpha, facet) / seen;
}

// The density with which the path chose its next direction; NO_OTHER if no shadow ray could go there.
float density_of(Microfacets surface, float choice, Bounce next) {
    if (next.is_mirrored) {
        return NO_OTHER;
    }
    return choice < surface.polished
        ? surface.polished * facet_density(surface, half_way(surface.view, next.direction))
        : (1.0 - surface.polished) * next.direction.z / PI;
}
// ANCHOR_END: density

// ANCHOR: balanced
// The weight of a shadow ray for the light from a direction: BRDF times cosine, divided by the density of shadow rays,
// and by that of bounces if these find the same light: `bounces` is 1 then, and else 0.
vec3 balanced(Microfacets surface, vec3 light, float density, float bounces) {
    if (light.z <= 0.0) {
        return vec3(0.0);
    }
    float cosine = light.z / PI;
    vec3 sum = rest_of(surface, light) * cosine / (density + bounces * (1.0 - surface.polished) * cosine);
    if (surface.alpha > 0.0) {
        vec3 facet = half_way(surface.view, light);
        vec3 mirrored = facet_fresnel(surface.head_on, surface.view, facet)
            * (0.5 * distribution(surface.alpha, facet) * unhidden(surface.alpha, surface.view, light));
        sum += mirrored / (density + bounces * surface.polished * facet_density(surface, facet));
    }
    return sum;
}
// ANCHOR_END: balanced
