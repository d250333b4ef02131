// The surface of the plane: squares, or one colour.
#include "common/scene.glsl"
#include "common/hit.glsl"
#include "common/plane.glsl"

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

// The light squares are 1, the dark ones 0. Far away a pixel covers many squares, and one alone is noise: where
// the ray's sine with the plane is small, they fade to grey. Chapter 43 computes what the pixel covers.
float squares(vec2 place, float sine) {
    float light = 1.0 - mod(floor(place.x) + floor(place.y), 2.0);
    return mix(0.5, light, smoothstep(0.02, 0.1, sine));
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

// The sides of the plane, which its hits have in place of a material.
const uint SIDE_OUTSIDE = 0;
const uint SIDE_INSIDE = 1;

// The plane at the distance t of a ray, reported as a hit shader reports a triangle. If it `shines`, its
// colour from inside is one of its own.
Hit hit_of_plane(Plane plane, Board board, bool shines, vec3 origin, vec3 direction, float t) {
    vec3 outward = normalize(plane.normal);
    bool inside = dot(direction, plane.normal) > 0.0;
    // From the anchor, not from the world's origin: small numbers near the camera. Then back onto the
    // plane, off which rounding has moved the point.
    vec3 from_anchor = origin - plane.anchor + t * direction;
    from_anchor -= (dot(from_anchor, plane.normal) - plane.rest)
        / dot(plane.normal, plane.normal) * plane.normal;
    vec2 place = board.anchor
        + vec2(dot(from_anchor, board.u), dot(from_anchor, board.v)) / board.square;
    float sine = abs(dot(direction, outward)) / length(direction);
    float light = board.checker == 0 ? 1.0 : squares(place, sine);

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
    return hit;
}
