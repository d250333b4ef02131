// Taught by 19_ray_cones.
//
// The footprint of a ray: a cone around it, and the part that it covers of a triangle and of the triangle's texture.

// ANCHOR: cone
struct Cone {
    float width;     // its diameter where the ray begins
    float spread;    // by how much that grows in a unit of length
};

float width_at(Cone cone, float t) {
    return cone.width + cone.spread * t;
}
// ANCHOR_END: cone

// Two steps on a triangle's plane. Between their ends, half before the point and half behind it, lies the footprint.
struct Axes {
    vec3 a;
    vec3 b;
};

// A ray along the surface would see it without end. The longest filter gives up long before.
const float GRAZING = 1e-4;

// Where the cone cuts the plane. Near the hit it is as good as a cylinder, and the cut is an ellipse: as wide as the
// cone, and as long as the ray is slanting.
Axes ellipse(float width, vec3 direction, vec3 face) {
    float cosine = dot(direction, face);
    vec3 along = direction - cosine * face;
    if (dot(along, along) < 1e-12) {
        // Looked at straight it is a circle, and any axis will do.
        along = cross(face, abs(face.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0));
    }
    along = normalize(along);
    return Axes(width / max(abs(cosine), GRAZING) * along, width * cross(face, along));
}

// Where the rays of the next pixel to the right and of the next one below would meet the plane (Igehy, "Tracing Ray
// Differentials", 1999). `right` and `down` are how far apart the rays are at distance 1.
Axes differentials(float t, vec3 direction, vec3 face, vec3 right, vec3 down) {
    float cosine = dot(direction, face);
    cosine = cosine < 0.0 ? min(cosine, -GRAZING) : max(cosine, GRAZING);
    return Axes(t * (right - dot(right, face) / cosine * direction),
                t * (down - dot(down, face) / cosine * direction));
}

// The gradients of the texture coordinates on a triangle, in the world.
struct Mapping {
    vec3 u;
    vec3 v;
};

// `e1` and `e2` are the triangle's edges from its first corner, `s1` and `s2` the same on the texture.
Mapping mapping_of(vec3 e1, vec3 e2, vec2 s1, vec2 s2) {
    // In units of the longer edge, so that no square is too large or too small.
    float size = max(length(e1), length(e2));
    vec3 a = e1 / max(size, 1e-30);
    vec3 b = e2 / max(size, 1e-30);
    vec3 normal = cross(a, b);
    float squared = dot(normal, normal);
    if (!(squared > 1e-24)) {
        return Mapping(vec3(0.0), vec3(0.0));   // no area: nothing to go along
    }
    // The gradients of the two barycentric coordinates.
    vec3 first = cross(b, normal) / (squared * size);
    vec3 second = cross(normal, a) / (squared * size);
    return Mapping(s1.x * first + s2.x * second, s1.y * first + s2.y * second);
}

// A step on the triangle, as a step on the texture.
vec2 on_texture(Mapping mapping, vec3 along) {
    return vec2(dot(mapping.u, along), dot(mapping.v, along));
}
