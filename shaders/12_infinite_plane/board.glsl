// What lies on the plane: squares, or one colour.
#include "common/scene.glsl"
#include "hit.glsl"
#include "ray.glsl"
#include "common/plane.glsl"
#include "common/checker.glsl"

struct Board {
    vec3 light;          // linear RGB
    vec3 dark;
    vec3 inner;          // of the plane seen from inside, where that shines
    float specular;
    float roughness;
    float reflection;    // what it mirrors when looked at straight
    uint checker;
    float square;        // length of a square's side
    vec3 u;              // unit vectors along the sides
    vec3 v;
    vec2 anchor;         // on which square the plane's anchor lies
};

const uint CHECKER_FILTERED = 0;
const uint CHECKER_POINT = 1;
const uint CHECKER_OFF = 2;

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

// The exponent of a highlight as wide as that of a surface of this roughness (Walter et al.,
// "Microfacet Models for Refraction", 2007, with their width as roughness squared).
float shininess(float roughness) {
    float width = roughness * roughness;
    return 2.0 / (width * width) - 2.0;
}

// What the board is made of, its colour apart.
MaterialRecord board_material(Board board) {
    MaterialRecord material;
    material.specular = vec3(board.specular);
    material.shininess = shininess(board.roughness);
    material.emission = vec3(0.0);
    return material;
}

// The sides of the plane, which its hits have in place of a material.
const uint SIDE_OUTSIDE = 0;
const uint SIDE_INSIDE = 1;

// The plane at the distance t of a ray, reported as a hit shader reports a triangle. If it `shines`, its
// colour from inside is one of its own.
CurvedHit hit_of_plane(Plane plane, Board board, bool shines, Ray ray, float t) {
    vec3 outward = normalize(plane.normal);
    bool inside = dot(ray.direction, plane.normal) > 0.0;
    // From the anchor, not from the world's origin: small numbers near the camera. Then back onto the
    // plane, off which rounding has moved the point.
    vec3 from_anchor = ray.origin - plane.anchor + t * ray.direction;
    from_anchor -= (dot(from_anchor, plane.normal) - plane.rest)
        / dot(plane.normal, plane.normal) * plane.normal;
    vec2 middle = vec2(dot(from_anchor, board.u), dot(from_anchor, board.v)) / board.square;
    float width = ray.width + ray.spread * t;
    vec2 box = footprint(width, ray.direction, outward, board.u, board.v) / board.square;
    box = board.checker == CHECKER_FILTERED ? box : vec2(0.0);
    float light = board.checker == CHECKER_OFF ? 1.0 : checker_light(board.anchor + middle, box);

    Hit hit;
    hit.position = plane.anchor + from_anchor;
    hit.offset = 0.0;   // a ray that leaves the plane is not tested against it
    hit.face = inside ? -outward : outward;
    hit.t = t;
    hit.normal = hit.face;
    hit.material = inside ? SIDE_INSIDE : SIDE_OUTSIDE;
    hit.color = shines && inside ? board.inner * light : mix(board.dark, board.light, light);
    hit.triangle = 0;
    hit.instance = PLANE;
    return CurvedHit(hit, 0.0);
}
