// The question of the laboratory, for the one primitive that PRIMITIVE names: the host defines it, so
// that no shader is compiled with all of them. RUNG is a specialization constant. After query.glsl.

#if PRIMITIVE == PRIMITIVE_SPHERE
#include "ask_sphere.glsl"
#define ASK ask_sphere
#elif PRIMITIVE == PRIMITIVE_BOX
#include "ask_box.glsl"
#define ASK ask_box
#elif PRIMITIVE == PRIMITIVE_PLANE
#include "ask_plane.glsl"
#define ASK ask_plane
#elif PRIMITIVE == PRIMITIVE_TRIANGLE
#include "ask_triangle.glsl"
#define ASK ask_triangle
#elif PRIMITIVE == PRIMITIVE_CAPSULE
#include "ask_capsule.glsl"
#define ASK ask_capsule
#elif PRIMITIVE == PRIMITIVE_INSTANCE
#include "ask_instance.glsl"
#define ASK ask_instance
#elif PRIMITIVE == PRIMITIVE_HEIGHTFIELD
#include "ask_heightfield.glsl"
#define ASK ask_heightfield
#elif PRIMITIVE == PRIMITIVE_SECONDARY_ORIGIN
#include "ask_secondary_origin.glsl"
#define ASK ask_secondary_origin
#elif PRIMITIVE == PRIMITIVE_ACCUMULATION
#include "ask_accumulation.glsl"
#define ASK ask_accumulation
#elif PRIMITIVE == PRIMITIVE_CONE
#include "ask_cone.glsl"
#define ASK ask_cone
#elif PRIMITIVE == PRIMITIVE_QUADRIC
#include "ask_quadric.glsl"
#define ASK ask_quadric
#elif PRIMITIVE == PRIMITIVE_PATCH
#include "ask_patch.glsl"
#define ASK ask_patch
#elif PRIMITIVE == PRIMITIVE_VOXEL
#include "ask_voxel.glsl"
#define ASK ask_voxel
#elif PRIMITIVE == PRIMITIVE_ALGEBRAIC
#include "ask_algebraic.glsl"
#define ASK ask_algebraic
#endif

#ifdef FLOAT64
#if PRIMITIVE == PRIMITIVE_SPHERE
#include "ask_sphere_f64.glsl"
#define ASK_FLOAT64 ask_sphere_f64
#elif PRIMITIVE == PRIMITIVE_BOX
#include "ask_box_f64.glsl"
#define ASK_FLOAT64 ask_box_f64
#elif PRIMITIVE == PRIMITIVE_PLANE
#include "ask_plane_f64.glsl"
#define ASK_FLOAT64 ask_plane_f64
#elif PRIMITIVE == PRIMITIVE_CAPSULE
#include "ask_capsule_f64.glsl"
#define ASK_FLOAT64 ask_capsule_f64
#elif PRIMITIVE == PRIMITIVE_CONE
#include "ask_cone_f64.glsl"
#define ASK_FLOAT64 ask_cone_f64
#elif PRIMITIVE == PRIMITIVE_QUADRIC
#include "ask_quadric_f64.glsl"
#define ASK_FLOAT64 ask_quadric_f64
#elif PRIMITIVE == PRIMITIVE_PATCH
#include "ask_patch_f64.glsl"
#define ASK_FLOAT64 ask_patch_f64
#elif PRIMITIVE == PRIMITIVE_VOXEL
#include "ask_voxel_f64.glsl"
#define ASK_FLOAT64 ask_voxel_f64
#elif PRIMITIVE == PRIMITIVE_ALGEBRAIC
#include "ask_algebraic_f64.glsl"
#define ASK_FLOAT64 ask_algebraic_f64
#endif
#endif

Answer ask(Query query, Numbers numbers) {
#ifdef ASK_FLOAT64
    return ASK_FLOAT64(query, numbers);
#else
    return ASK(RUNG, query, numbers);
#endif
}
