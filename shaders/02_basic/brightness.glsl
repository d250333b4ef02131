// How bright the sun makes a surface.

// Lambert's law and a normalised Blinn-Phong highlight (Akenine-Moeller et al., Real-Time Rendering,
// 4th ed., section 9.8). All vectors are unit; `view` points to the eye, `light` to the light.
//
// From 03 on `reflect_light` of common/shade.glsl takes the place of this function. It also holds where eye
// and light are exactly opposite, and for highlights as small as a mirror's: pow() loses digits near 1.
vec3 brightness(vec3 base, vec3 specular, float shininess, vec3 normal, vec3 view, vec3 light) {
    // ANCHOR: lambert
    float lambert = max(dot(normal, light), 0.0);
    // ANCHOR_END: lambert
    vec3 half_way = normalize(view + light);
    // A base of 0 or less is undefined for pow().
    float highlight = pow(max(dot(normal, half_way), 1e-6), shininess);
    return (base + specular * highlight * (shininess + 8.0) / 8.0) * lambert / 3.14159265;
}
