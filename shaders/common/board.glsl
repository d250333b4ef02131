// Taught by 12_infinite_plane; this one is for hit and miss shaders that light the plane themselves.
//
// The plane where a ray has met it: a board of squares.

// ANCHOR: footprint
// How wide the cone of a pixel's rays is on the plane, along two axes of the plane: an ellipse, as long
// as the ray is slanting (Amanatides, "Ray Tracing with Cones", 1984).
vec2 footprint(float width, vec3 direction, vec3 normal, vec3 u, vec3 v) {
    vec3 along = direction - dot(direction, normal) * normal;
    float length_along = length(along);
    along = length_along > 0.0 ? along / length_along : u;
    vec3 across = cross(normal, along);
    // Rounded, a slope may be 0 that is not; then any large footprint is right, but 0 / 0 is not.
    float slant = max(abs(dot(direction, normal)) / length(direction), 1e-30);
    return width * vec2(length(vec2(dot(along, u) / slant, dot(across, u))),
                        length(vec2(dot(along, v) / slant, dot(across, v))));
}
// ANCHOR_END: footprint

// ANCHOR: shininess
// The exponent of a highlight as wide as that of a surface of this roughness (Walter et al.,
// "Microfacet Models for Refraction", 2007, with their width as roughness squared).
float shininess(float roughness) {
    float width = roughness * roughness;
    return 2.0 / (width * width) - 2.0;
}
// ANCHOR_END: shininess

// ANCHOR: plane
// Shades the plane by the code that shades everything else.
void shade_plane() {
    Plane plane = push.world.plane;
    Board board = push.world.board;
    vec3 direction = gl_WorldRayDirectionEXT;
    vec3 outward = normalize(plane.normal);
    bool inside = dot(direction, plane.normal) > 0.0;

    // From the anchor, not from the world's origin: small numbers near the camera. And onto the plane,
    // which rounding has left.
    vec3 from_anchor = payload.origin - plane.anchor + payload.plane * direction;
    from_anchor -= (dot(from_anchor, plane.normal) - plane.rest)
        / dot(plane.normal, plane.normal) * plane.normal;
    vec2 middle = vec2(dot(from_anchor, board.u), dot(from_anchor, board.v)) / board.square;
    float width = payload.width + payload.spread * payload.plane;
    vec2 box = footprint(width, direction, outward, board.u, board.v) / board.square;
    box = board.checker == CHECKER_FILTERED ? box : vec2(0.0);
    float light = board.checker == CHECKER_OFF ? 1.0 : checker_light(board.anchor + middle, box);

    Met met;
    met.t = payload.plane;
    met.position = plane.anchor + from_anchor;
    met.normal = inside ? -outward : outward;
    met.flat_normal = met.normal;
    met.lift = vec3(0.0);
    met.up = met.normal;
    met.on_plane = true;
    met.curvature = 0.0;
    met.material.base_color = mix(board.dark, board.light, light);
    met.material.specular = vec3(board.specular);
    met.material.shininess = shininess(board.roughness);
    met.material.emission = vec3(0.0);
    met.reflection = vec3(board.reflection);
    if (inside && push.world.inside == INSIDE_COLOR) {
        met.material.base_color = vec3(0.0);
        met.material.specular = vec3(0.0);
        met.material.emission = board.inner * light;
        met.reflection = vec3(0.0);
    }
    shade(met, vec4(-2.0, light, payload.plane, inside ? 1.0 : 0.0), vec3(light));
}
// ANCHOR_END: plane
