// Taught by 41_ray_offset.
//
// Where a ray may start that leaves the triangle that was hit, for a closest hit shader: its built-in
// variables say which ray it was, and where the instance lies.
#include "ray_offset.glsl"

HitPoint hit_point(InstanceRecord instance, uint triangle, vec2 barycentrics) {
    return hit_point(instance, triangle, barycentrics, gl_ObjectToWorldEXT, gl_WorldToObjectEXT,
        gl_WorldRayDirectionEXT);
}
