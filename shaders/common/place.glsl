// Taught by 05_shadow_miss.
//
// Where a ray may start that leaves the triangle that was hit, for a closest hit shader: its built-in
// variables say which ray it was, and where the instance lies.
#include "above.glsl"

// Fills position, face, height and lift of a hit.
void place(inout Hit hit, InstanceRecord instance, uint triangle, vec2 weights) {
    place(hit, instance, triangle, weights, gl_ObjectToWorldEXT, gl_WorldToObjectEXT,
        gl_WorldRayDirectionEXT);
}
