// Taught by 02_basic.
//
// The look of a surface under a sky and a distant light. The same in every chapter.

struct DirectionalLight {
    vec3 direction;   // towards the light
    vec3 radiance;
};

// The sky in a direction: pale at the horizon, bluer above, and a cool grey backdrop below.
vec3 sky(vec3 direction) {
    vec3 horizon = vec3(0.84, 0.87, 0.90);
    if (direction.y > 0.0) {
        return mix(horizon, vec3(0.23, 0.38, 0.62), sqrt(direction.y));
    }
    return mix(horizon, vec3(0.20, 0.245, 0.29), smoothstep(0.0, 0.45, -direction.y));
}

// The light of the sky from all sides: more from above than from below.
vec3 ambient(vec3 normal) {
    return mix(vec3(0.16, 0.14, 0.12), vec3(0.42, 0.47, 0.55), 0.5 + 0.5 * normal.y);
}

// The cosine 1 - s, raised to the power n. Not by pow(), which is undefined for 0 to the power 0, and
// whose log2 may be off by 2^-21 near 1: a ninth of the highlight where n is 320,000. There, ln(1 - s) is
// -2·artanh(s / (2 - s)), and five terms of that are off by less than 2^-18 of it.
float power_of_cosine(float s, float n) {
    float z = s / (2.0 - s);
    float zz = z * z;
    float near_one = -2.0 * z * (1.0 + zz * (1.0 / 3.0 + zz * (1.0 / 5.0 + zz * (1.0 / 7.0 + zz / 9.0))));
    return exp(n * (s < 0.5 ? near_one : log(max(1.0 - s, 1e-30))));
}

// Lambert's law and a normalised Blinn-Phong highlight (Akenine-Moeller et al., Real-Time Rendering,
// 4th ed., section 9.8). All vectors are unit; `view` points to the eye, `light` to the light.
// ANCHOR: brightness
vec3 reflect_light(vec3 base, vec3 specular, float shininess, vec3 normal, vec3 view, vec3 light) {
    // ANCHOR: lambert
    float lambert = max(dot(normal, light), 0.0);
    // ANCHOR_END: lambert
    // Eye and light may be opposite: then their sum is 0, and has no direction.
    vec3 half_way = view + light;
    half_way *= inversesqrt(max(dot(half_way, half_way), 1e-30));
    // Half the squared distance of unit vectors is 1 - cosine, with more digits than the cosine can hold.
    vec3 apart = normal - half_way;
    float highlight = power_of_cosine(0.5 * dot(apart, apart), shininess);
    return (base + specular * highlight * (shininess + 8.0) / 8.0) * lambert / 3.14159265;
}
// ANCHOR_END: brightness
