// How a surface looks under a sky and a distant light. The same in every chapter.

struct DirectionalLight {
    vec3 direction;   // towards the light
    vec3 radiance;
};

// The sky in a direction: a pale horizon, bluer above, warm below.
vec3 sky(vec3 direction) {
    float height = direction.y;
    vec3 above = mix(vec3(0.80, 0.84, 0.88), vec3(0.23, 0.38, 0.62), sqrt(max(height, 0.0)));
    vec3 below = mix(vec3(0.80, 0.84, 0.88), vec3(0.30, 0.27, 0.24), min(-8.0 * height, 1.0));
    return height > 0.0 ? above : below;
}

// What the sky sends to a surface from all sides: more from above than from below.
vec3 ambient(vec3 normal) {
    return mix(vec3(0.16, 0.14, 0.12), vec3(0.42, 0.47, 0.55), 0.5 + 0.5 * normal.y);
}

// Lambert's law and a normalised Blinn-Phong highlight (Akenine-Moeller et al., Real-Time Rendering,
// 4th ed., section 9.8). All vectors are unit; `view` points to the eye, `light` to the light.
vec3 reflect_light(vec3 base, vec3 specular, float shininess, vec3 normal, vec3 view, vec3 light) {
    float lambert = max(dot(normal, light), 0.0);
    float highlight = pow(max(dot(normal, normalize(view + light)), 0.0), shininess);
    return (base + specular * highlight * (shininess + 8.0) / 8.0) * lambert / 3.14159265;
}
