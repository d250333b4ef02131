// Taught by 05_shadow_miss.
//
// Where a ray may start that leaves the triangle that was hit, for a closest hit shader: its built-in
// variables say which ray it was, and where the instance lies.
#include "above.glsl"

// Fills position, face and height of a hit.
void place(inout Hit hit, InstanceRecord instance, uint triangle, vec2 weights) {
    place(hit, instance, triangle, weights, gl_ObjectToWorldEXT, gl_WorldToObjectEXT,
        gl_WorldRayDirectionEXT);
}

// From the flat triangle to the round surface that its normals pretend.
vec3 lift_to_smooth(vec3 face, InstanceRecord instance, uint triangle, vec2 weights) {
    return lift_to_smooth(face, instance, triangle, weights, gl_ObjectToWorldEXT);
}
