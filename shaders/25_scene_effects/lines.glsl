// Lines along the edges of a triangle, as wide in pixels as asked for: as chapter 20 has them, for every ray
// that has a cone.

// The part of a pixel that the lines of a triangle cover, 0 to 1. `cone` is the width of the ray's cone at its
// origin, and by how much it widens.
float line_coverage(vec3 corners[3], vec3 origin, vec3 direction, vec2 cone, float width) {
    // Many curved mirrors widen a cone beyond what floats can say.
    cone = min(cone, vec2(1e15));
    // The tip of the cone is where the picture is seen from: the eye, or its image behind flat mirrors. Tip
    // and edge span a plane. Divide the sine of the angle between plane and ray by the sine of a pixel's
    // angle: so many pixels lie between the edge and the ray.
    vec3 tip = origin - cone.x / cone.y * direction;
    vec3 edges[3] = vec3[](corners[2] - corners[1], corners[0] - corners[2], corners[1] - corners[0]);
    float nearest = FAR;
    for (int k = 0; k < 3; k++) {
        vec3 n = cross(corners[(k + 1) % 3] - tip, edges[k]);
        // Any length will do: this one keeps the square below in range, whatever the scene's unit.
        vec3 size = abs(n);
        n /= max(max(size.x, max(size.y, size.z)), 1e-37);
        nearest = min(nearest, abs(dot(n, direction)) / (cone.y * length(n)));
    }
    // The overlap of the line and the pixel, which is 1 wide.
    float half_width = 0.5 * width;
    return clamp(min(nearest + 0.5, half_width) - max(nearest - 0.5, -half_width), 0.0, 1.0);
}
