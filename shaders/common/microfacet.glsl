// Taught by 45_rough_metal.
//
// A surface of microfacets: tiny mirrors, each turned a little from the normal.
//
// Directions are in the surface's own frame, whose z is the normal: `view` points to the eye, `light` to the light,
// and a facet mirrors one into the other if its own normal is half way between them.
#include "frame.glsl"
#include "surface.glsl"
#include "albedo.glsl"

const float PI = 3.14159265;

// Below this alpha the reflection is narrower than the rounding of a unit vector: the surface is a mirror.
const float SMOOTH = 1e-6;

// No view is lower, so that nothing is divided by zero.
const float GRAZING = 1e-5;

// The reflectance of an insulator head-on (glTF 2.0, section 3.9.2).
const vec3 INSULATOR = vec3(0.04);

// ANCHOR: distribution
// GGX: how densely the facets' normals lie around a direction (Trowbridge and Reitz 1975). `alpha` is the tangent
// of the angle within which half of them lie.
float distribution(float alpha, vec3 facet) {
    float narrow = alpha * alpha;
    // The squared sine of the facet's angle, and a little for the width.
    float spread = FORM == FORM_TEXTBOOK
        ? facet.z * facet.z * (narrow - 1.0) + 1.0
        : dot(facet.xy, facet.xy) + narrow * facet.z * facet.z;
    return narrow / (PI * spread * spread);
}
// ANCHOR_END: distribution

// ANCHOR: shadowing
// The cosine of a direction after the surface is stretched until its facets are turned as far as with alpha = 1.
float stretched(float alpha, float cosine) {
    return sqrt(cosine * cosine + alpha * alpha * max(1.0 - cosine * cosine, 0.0));
}

// Facets hide each other from eye and light: Smith's G (1967), with the heights correlated (Heitz 2014), and
// divided by twice the view's cosine, which it nearly cancels.
float unhidden(float alpha, vec3 view, vec3 light) {
    return light.z / (light.z * stretched(alpha, view.z) + view.z * stretched(alpha, light.z));
}
// ANCHOR_END: shadowing

// The direction half way between two, with a length of 1.
vec3 half_way(vec3 view, vec3 light) {
    vec3 sum = view + light;
    return sum * inversesqrt(max(dot(sum, sum), 1e-30));
}

// The part of the light that a facet mirrors; rounding may make the cosine of unit vectors greater than 1.
vec3 facet_fresnel(vec3 head_on, vec3 view, vec3 facet) {
    return fresnel(head_on, clamp(dot(view, facet), 0.0, 1.0));
}

// The light that an insulator's polish lets pass; at a grazing angle rounding could make it negative.
vec3 below_polish(Albedo albedo, float cosine) {
    return max(1.0 - reflected(INSULATOR, albedo, cosine), 0.0);
}

// ANCHOR: surface
// Metalness mixes a metal and an insulator, both of one colour (glTF 2.0, appendix B).
struct Microfacets {
    vec3 view;
    float alpha;         // 0 for a mirror
    vec3 head_on;        // what a facet reflects head-on
    float polished;      // the probability that a path is mirrored by a facet
    vec3 metal;          // the colour of what metal reflects after two or more facets
    vec3 matte;          // the colour below an insulator's polish
    Albedo seen;         // from the view
    Albedo all;          // the mean over all directions
    float roughness;
    RoughAddresses rough;    // the table of what facets reflect in all
};

// The part of the light from all sides that the facets reflect at first.
vec3 by_facets(Microfacets surface) {
    return COMPENSATION ? reflected(surface.head_on, surface.seen, surface.view.z)
        : fresnel(surface.head_on, surface.view.z);
}

// The part that the rest sends to the eye.
vec3 by_rest(Microfacets surface) {
    return COMPENSATION
        ? surface.metal * surface.seen.lost + surface.matte * below_polish(surface.seen, surface.view.z)
        : surface.matte * max(1.0 - fresnel(INSULATOR, surface.view.z), 0.0);
}

Microfacets microfacets(RoughAddresses rough, vec3 color, float roughness, float metallic, vec3 view) {
    Microfacets surface;
    surface.rough = rough;
    surface.view = vec3(view.xy, max(abs(view.z), GRAZING));
    surface.alpha = roughness * roughness < SMOOTH ? 0.0 : roughness * roughness;
    surface.roughness = roughness;
    surface.head_on = mix(INSULATOR, color, metallic);
    surface.matte = (1.0 - metallic) * color;
    surface.metal = vec3(0.0);
    if (COMPENSATION) {
        surface.seen = albedo(surface.rough, surface.alpha, roughness, surface.view.z);
        surface.all = mean_albedo(rough, surface.alpha, roughness);
        surface.metal = metallic * reflected_again(color, surface.all);
    }
    float polish = largest(by_facets(surface));
    surface.polished = polish / max(polish + largest(by_rest(surface)), 1e-30);
    return surface;
}
// ANCHOR_END: surface

// ANCHOR: rest
// Pi times the BRDF of everything but the facets' first reflection: what metal reflects after several of them, and
// the matte base of an insulator. The same if light and view change places.
vec3 rest_of(Microfacets surface, vec3 light) {
    if (!COMPENSATION) {
        // glTF 2.0, appendix B: light passes the polish once.
        vec3 facet = half_way(surface.view, light);
        return surface.matte * max(1.0 - facet_fresnel(INSULATOR, surface.view, facet), 0.0);
    }
    Albedo lit = albedo(surface.rough, surface.alpha, surface.roughness, light.z);
    vec3 metal = surface.metal * surface.seen.lost * lit.lost / max(surface.all.lost, 1e-30);
    vec3 passed = below_polish(surface.seen, surface.view.z) * below_polish(lit, light.z)
        / (1.0 - mean_reflected(INSULATOR, surface.all));
    return metal + surface.matte * passed;
}
// ANCHOR_END: rest

// ANCHOR: reflect
// The part of the light from a direction that goes to the eye: BRDF times cosine.
vec3 reflected_from(Microfacets surface, vec3 light) {
    if (light.z <= 0.0) {
        return vec3(0.0);
    }
    vec3 sum = rest_of(surface, light) * light.z / PI;
    // No light of a single direction finds the way that a perfect mirror sends it.
    if (surface.alpha > 0.0) {
        vec3 facet = half_way(surface.view, light);
        sum += facet_fresnel(surface.head_on, surface.view, facet)
            * (0.5 * distribution(surface.alpha, facet) * unhidden(surface.alpha, surface.view, light));
    }
    return sum;
}
// ANCHOR_END: reflect

// ANCHOR: facet
// A facet with a density of D times its cosine: some are hidden from the eye, or mirror it into the surface.
vec3 random_facet(float alpha, vec2 u) {
    // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
    float angle = 6.283185 * (u.y - 0.5);
    return normalize(vec3(alpha * sqrt(u.x) * vec2(cos(angle), sin(angle)), sqrt(1.0 - u.x)));
}
// ANCHOR_END: facet

// ANCHOR: visible
// A facet that the eye sees, as often as it fills the view (Heitz 2018). Stretched, the facets are those of a
// hemisphere, and the directions that they mirror the view to fill a cap of the sphere evenly (Dupuy and Benyoub
// 2023). With `bound` below 1 the cap is smaller: it leaves out some that are mirrored into the surface.
vec3 visible_facet(float alpha, vec3 view, float bound, vec2 u) {
    vec3 stretched_view = normalize(vec3(alpha * view.xy, view.z));
    float angle = 6.283185 * (u.y - 0.5);
    // 1 - z instead of z, for the digits of a facet that is hardly turned.
    float down = u.x * (1.0 + bound * stretched_view.z);
    float radius = sqrt(down * max(2.0 - down, 0.0));
    vec3 facet = stretched_view + vec3(radius * vec2(cos(angle), sin(angle)), 1.0 - down);
    return normalize(vec3(alpha * facet.xy, max(facet.z, 1e-6)));
}

// The lower edge of the cap: every facet beyond it mirrors the view into the surface (Eto and Tokuyoshi 2023).
float bound_of(float alpha, vec3 view) {
    float s = 1.0 + length(view.xy);
    return (1.0 - alpha * alpha) * s * s / (s * s + alpha * alpha * view.z * view.z);
}
// ANCHOR_END: visible

// A way for a path to go on.
struct Bounce {
    vec3 direction;
    vec3 weight;       // BRDF times cosine, divided by the density of the direction
    bool is_mirrored;  // by the surface as a whole: `direction` is that of a perfect mirror
};

// ANCHOR: bounce
// Mirrored by a facet. D is in the BRDF and in the density, so it cancels: no digit of it is lost.
Bounce by_facet(Microfacets surface, vec2 u) {
    float alpha = surface.alpha;
    vec3 view = surface.view;
    float bound = SAMPLING == SAMPLING_BOUNDED ? bound_of(alpha, view) : 1.0;
    vec3 facet = SAMPLING == SAMPLING_DISTRIBUTION ? random_facet(alpha, u)
        : visible_facet(alpha, view, bound, u);
    float cosine = dot(view, facet);
    vec3 light = normalize(2.0 * cosine * facet - view);
    if (cosine <= 0.0 || light.z <= 0.0) {
        return Bounce(vec3(0.0, 0.0, 1.0), vec3(0.0), false);
    }
    float weight = unhidden(alpha, view, light)
        * (SAMPLING == SAMPLING_DISTRIBUTION ? 2.0 * cosine / facet.z
            : bound * view.z + stretched(alpha, view.z));
    return Bounce(light, facet_fresnel(surface.head_on, view, facet) * weight, false);
}

// One of two ways: mirrored by a facet, or scattered by the rest. Each stands for its own part of the light, so
// the weight of one needs nothing of the other.
Bounce bounce(Microfacets surface, float choice, vec2 u) {
    Bounce next;
    if (choice < surface.polished) {
        if (surface.alpha == 0.0) {
            next = Bounce(vec3(0.0), fresnel(surface.head_on, surface.view.z), true);
        } else {
            next = by_facet(surface, u);
        }
        next.weight /= surface.polished;
    } else {
        vec3 light = cosine_direction(u, vec3(0.0, 0.0, 1.0));
        next = Bounce(light, rest_of(surface, light) / (1.0 - surface.polished), false);
    }
    return next;
}
// ANCHOR_END: bounce
