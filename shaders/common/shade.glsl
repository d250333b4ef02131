// Taught by 02_basic, whose own file this is a copy of.
//
// How a surface looks under a sky and a distant light. The same in every chapter.

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

// What the sky sends to a surface from all sides: more from above than from below.
vec3 ambient(vec3 normal) {
    return mix(vec3(0.16, 0.14, 0.12), vec3(0.42, 0.47, 0.55), 0.5 + 0.5 * normal.y);
}

// ANCHOR: reflect
// Lambert's law and a normalised Blinn-Phong highlight (Akenine-Moeller et al., Real-Time Rendering,
// 4th ed., section 9.8). All vectors are unit; `view` points to the eye, `light` to the light.
vec3 reflect_light(vec3 base, vec3 specular, float shininess, vec3 normal, vec3 view, vec3 light) {
    float lambert = max(dot(normal, light), 0.0);
    float highlight = pow(max(dot(normal, normalize(view + light)), 0.0), shininess);
    return (base + specular * highlight * (shininess + 8.0) / 8.0) * lambert / 3.14159265;
}
// ANCHOR_END: reflect
