// Taught by 19_ray_cones.
//
// Texture lookup: its level and place. After `textures`, an array of samplers.

// As many lookups as one takes along a footprint.
const float MOST = 16.0;

// The level whose texels are this many texels of level 0 wide. NaN gives level 0, because every comparison with it
// is false.
float level_of(float texels) {
    return texels > 1.0 ? log2(min(texels, 1e9)) : 0.0;
}

// One number for the whole footprint: how many texels of level 0 the cone is wide, on a surface that slants away
// (Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, 2019).
// The mapping stretches areas; lengths by the root of that.
float texels_of_cone(float width, float cosine, Mapping mapping, vec2 size) {
    // In units of the larger gradient, so that no square is too large or too small.
    float most = max(length(mapping.u), length(mapping.v));
    float area = length(cross(mapping.u / max(most, 1e-30), mapping.v / max(most, 1e-30)));
    float stretch = most * sqrt(area * size.x * size.y);
    return width / max(abs(cosine), GRAZING) * stretch;
}

// Lookups in a row.
struct Row {
    vec2 between;    // from one to the next, in texture coordinates
    int count;
    float level;
};

// Lookups along the longer axis of a footprint, each as wide as the shorter one.
Row row_of(vec2 a, vec2 b, vec2 size) {
    float length_a = length(a * size);
    float length_b = length(b * size);
    bool is_a = length_a > length_b;
    float longer = is_a ? length_a : length_b;
    float shorter = is_a ? length_b : length_a;
    float count = 1.0;
    // NaN and infinity get one lookup.
    if (longer > 1.0 && longer < 1e9) {
        // Not max(), which may return a NaN.
        float wide = shorter > 1.0 ? shorter : 1.0;
        // A tenth of a lookup is not worth a whole one: lookups may lie that much farther apart.
        count = clamp(ceil(longer / wide - 0.1), 1.0, MOST);
    }
    vec2 between = count > 1.0 ? (is_a ? a : b) / count : vec2(0.0);
    return Row(between, int(count), level_of(max(longer / count, shorter)));
}

// The mean of the lookups.
vec3 texture_along(int index, vec2 uv, Row row) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < row.count; i++) {
        vec2 at = uv + (float(i) + 0.5 - 0.5 * float(row.count)) * row.between;
        sum += textureLod(textures[nonuniformEXT(index)], at, row.level).rgb;
    }
    return sum / float(row.count);
}
