#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "lighting.glsl"

#ifdef DEPARTURES
// A line meets a plane once: no care is needed.
Start start_from(Met met, vec3 direction) {
    return Start(met.position, 0.0);
}
#endif

// The ray met nothing before the plane: it meets the plane.
void main() {
    Plane plane = push.world.plane;
    Board board = push.world.board;
    vec3 direction = gl_WorldRayDirectionEXT;
    vec3 outward = normalize(plane.normal);
    // From the anchor, near the camera, and onto the plane, which rounding has left.
    precise vec3 from_anchor = gl_WorldRayOriginEXT - plane.anchor + payload.plane * direction;
    from_anchor -= (dot(from_anchor, plane.normal) - plane.rest)
        / dot(plane.normal, plane.normal) * plane.normal;
    vec2 middle = vec2(dot(from_anchor, board.u), dot(from_anchor, board.v)) / board.square;
    vec2 width = footprint(payload.plane, direction, outward, board.u, board.v) / board.square;

    Met met;
    met.t = payload.plane;
    met.position = plane.anchor + from_anchor;
    met.normal = dot(direction, plane.normal) > 0.0 ? -outward : outward;
    met.flat_normal = met.normal;
    met.lift = vec3(0.0);
    met.up = met.normal;
    met.on_plane = true;
    met.curvature = 0.0;
    met.base_color = mix(board.dark, board.light, checker_light(board.anchor + middle, width));
    met.specular = vec3(0.03);
    met.shininess = 90.0;
    met.emission = vec3(0.0);
    met.reflection = vec3(board.reflection);
    shade(met);
}
