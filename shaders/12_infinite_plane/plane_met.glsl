// The plane, where a ray has met it.

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

// ANCHOR: plane
// Shades the plane by the code that shades everything else.
void shade_plane() {
    PlaneLook look = push.look.at[0];
    vec3 direction = gl_WorldRayDirectionEXT;
    vec3 outward = normalize(push.plane.normal);
    bool inside = dot(direction, push.plane.normal) > 0.0;

    // From the anchor, not from the world's origin: small numbers near the camera.
    vec3 point = payload.origin + payload.plane * direction;
    point -= (dot(point - push.plane.anchor, push.plane.normal) - push.plane.rest)
        / dot(push.plane.normal, push.plane.normal) * push.plane.normal;
    vec3 u = plane_axis(outward);
    vec3 v = cross(u, outward);
    vec3 from_anchor = point - push.plane.anchor;
    vec2 square = push.anchor_square + vec2(dot(from_anchor, u), dot(from_anchor, v)) / look.square;
    float width = payload.width + payload.spread * payload.plane;
    vec2 box = footprint(width, direction, outward, u, v) / look.square;
    float light = look.checker == CHECKER_OFF
        ? 1.0
        : checker_light(square, look.checker == CHECKER_FILTERED ? box : vec2(0.0));

    Met met;
    met.t = payload.plane;
    met.normal = inside ? -outward : outward;
    met.from.position = point;
    met.from.normal = met.normal;
    met.lift = vec3(0.0);
    met.up = met.normal;
    met.on_plane = true;
    met.curvature = 0.0;
    met.base = mix(look.dark, look.light, light);
    met.emission = vec3(0.0);
    met.specular = vec3(look.specular);
    met.shininess = look.shininess;
    met.reflection = vec3(look.reflection);
    if (inside && push.inside == INSIDE_COLOR) {
        met.base = vec3(0.0);
        met.specular = vec3(0.0);
        met.reflection = vec3(0.0);
        met.emission = look.inner * light;
    }
    shade(met, vec4(-2.0, light, payload.plane, inside ? 1.0 : 0.0), vec3(light));
}
// ANCHOR_END: plane
