// Taught by 27_glass.
//
// Reflection and refraction at a smooth surface between two transparent media.

// The optical properties of a material.
struct Glass {
    vec3 absorption;  // exp(-absorption) of the light is left after a unit of length
    float index;      // of refraction
    uint kind;
};

const uint GLASS_NONE = 0;
const uint GLASS_THICK = 1;   // its surface is the skin of a body
const uint GLASS_THIN = 2;    // its surface is a sheet, both of whose sides are the skin

// The part of the light that a body lets through. Clear glass takes nothing at all: Vulkan lets exp(0)
// be off by 3 ULP.
vec3 left_after(vec3 absorption) {
    return mix(exp(-absorption), vec3(1.0), equal(absorption, vec3(0.0)));
}

// The parts of the light that a surface reflects and lets through: x of the light that swings across
// the plane of ray and normal, y of that which swings within it.
struct Split {
    vec2 reflected;
    vec2 through;
};

// The part of light that is not polarised: half of it swings either way.
float unpolarised(vec2 part) {
    return 0.5 * (part.x + part.y);
}

// Fresnel's equations, from a medium of index `from` into one of index `to`; `cosine` is the ray's to the
// normal.
//
// q and p are index·cosine before and behind the surface, k2 is (index·sine)^2: by Snell's law the same on
// both sides. So p^2 - q^2 = to^2 - from^2, and the difference that Fresnel's equations have, q - p, is a
// quotient that does not cancel, however near the indices are to each other.
Split fresnel_exact(float cosine, float from, float to) {
    float q = from * cosine;
    float squares = (to - from) * (to + from);
    float p2 = squares + q * q;
    if (p2 <= 0.0) {
        return Split(vec2(1.0), vec2(0.0));    // total reflection
    }
    float p = sqrt(p2);
    float k2 = from * from * (1.0 - cosine) * (1.0 + cosine);
    float sum = q + p;
    float across = squares / (sum * sum);              // the amplitude perpendicular to the plane
    float within = (q * p - k2) / (q * p + k2);        // the parallel amplitude, relative to it
    float relative = from * to / (q * p + k2);
    return Split(
        across * across * vec2(1.0, within * within),
        4.0 * q * p / (sum * sum) * vec2(1.0, relative * relative)
    );
}

// Between the two sides of a sheet light goes to and fro: R + T²R + T²R³ + … = 2R / (1 + R) comes back. Each
// polarisation has a series of its own: the mean of R in place of both reflects up to 8 % too much.
Split of_sheet(Split side) {
    vec2 all = 1.0 + side.reflected;
    return Split(2.0 * side.reflected / all, side.through / all);
}

// The direction of a refracted ray. Along the surface index·direction does not change, and
// along the normal -q becomes -p.
vec3 refracted(vec3 direction, vec3 normal, float from, float to) {
    float q = from * dot(-direction, normal);
    float squares = (to - from) * (to + from);
    float sum = q + sqrt(max(squares + q * q, 0.0));
    return normalize(from * direction - squares / sum * normal);
}
