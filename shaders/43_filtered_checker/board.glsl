// The surface of the plane: squares, or one colour.
#include "common/scene.glsl"
#include "common/hit.glsl"
#include "common/plane.glsl"
#include "common/checker.glsl"

const uint PLANE = -2;   // the plane's `instance`

struct Board {
    vec3 light;          // linear RGB
    vec3 dark;
    vec3 inner;          // of the plane seen from inside, where that shines
    float specular;
    float roughness;
    float reflection;    // what it mirrors when looked at straight
    uint checker;        // 1 for squares, 0 for one colour
    float square;        // length of a square's side
    vec3 u;              // unit vectors along the sides
    vec3 v;
    vec2 anchor;         // on which square the plane's anchor lies
};

// The method that draws the squares.
layout(constant_id = 1) const uint CHECKER = 0;
const uint CHECKER_FILTERED = 0;   // averaged over the pixel
const uint CHECKER_POINT = 1;      // sampled at its centre

// The size of the cone of a pixel's rays on the plane, along two axes of the plane. It is an ellipse: as wide as
// the cone, and longer by as much as the ray is slanting (Amanatides, "Ray Tracing with Cones", 1984).
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

// The exponent of a highlight as wide as that of a surface of this roughness (Walter et al.,
// "Microfacet Models for Refraction", 2007, with their width as roughness squared).
float shininess(float roughness) {
    float width = roughness * roughness;
    return 2.0 / (width * width) - 2.0;
}

// The material of the board, without its colour.
MaterialRecord board_material(Board board) {
    MaterialRecord material;
    material.specular = vec3(board.specular);
    material.shininess = shininess(board.roughness);
    material.emission = vec3(0.0);
    return material;
}

// The plane at the distance t of a ray, reported as a hit shader reports a triangle. There the cone of the
// pixel's rays is as wide as `width`.
Hit hit_of_plane(Plane plane, Board board, vec3 origin, vec3 direction, float t, float width) {
    // From the anchor, not from the world's origin: small numbers near the camera. Then back onto the
    // plane, off which rounding has moved the point.
    vec3 from_anchor = origin - plane.anchor + t * direction;
    from_anchor -= (dot(from_anchor, plane.normal) - plane.rest)
        / dot(plane.normal, plane.normal) * plane.normal;
    vec2 place = board.anchor
        + vec2(dot(from_anchor, board.u), dot(from_anchor, board.v)) / board.square;
    vec2 box = footprint(width, direction, plane.normal, board.u, board.v) / board.square;
    box = CHECKER == CHECKER_FILTERED ? box : vec2(0.0);
    float light = board.checker == 0 ? 1.0 : checker_light(place, box);

    Hit hit;
    hit.position = plane.anchor + from_anchor;
    hit.offset = 0.0;   // on the plane exactly, and below everything else
    hit.face = faceforward(plane.normal, direction, plane.normal);
    hit.t = t;
    hit.normal = hit.face;
    hit.material = 0;
    hit.color = mix(board.dark, board.light, light);
    hit.triangle = 0;
    hit.instance = PLANE;
    return hit;
}
