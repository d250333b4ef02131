#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_NV_linear_swept_spheres : require

layout(location = 0) rayPayloadInEXT vec3 normal;

// ANCHOR: normal
// Away from the centre of the ball that touches `p`.
vec3 normal_at(vec3 p, vec3 ends[2], float radii[2]) {
    vec3 u = ends[1] - ends[0];
    float delta = radii[1] - radii[0];
    float k = dot(u, u) - delta * delta;
    float s = k > 0.0 ? (dot(p - ends[0], u) + delta * radii[0]) / k : step(0.0, delta);
    return normalize(p - mix(ends[0], ends[1], clamp(s, 0.0, 1.0)));
}
// ANCHOR_END: normal

// ANCHOR: main
void main() {
    vec3 p = gl_ObjectRayOriginEXT + gl_HitTEXT * gl_ObjectRayDirectionEXT;
    vec3 outward = normal_at(p, gl_HitLSSPositionsNV, gl_HitLSSRadiiNV);
    normal = normalize(vec3(outward * gl_WorldToObjectEXT));
}
// ANCHOR_END: main
