// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

struct Sphere {
    vec3 center;
    float radius;
    uint material;
};

struct Box {
    vec3 low;
    vec3 high;
    uint material;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Spheres { Sphere at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Boxes { Box at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer HostC { float at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShapeAddresses {
    Spheres spheres;
    Boxes boxes;
    Original sphere_ids;   // primitive i of the build is sphere sphere_ids.at[i]
    Original box_ids;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    ShapeAddresses shapes;
    HostC host_c;         // of each sphere: |camera - center|^2 - radius^2
    DirectionalLight light;
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_KIND = 7;

// A scene says whether its shadows are worth their time.
layout(constant_id = 1) const bool SHADOWS = true;

// Hit kinds of intersection shaders go from 0 to 127; those of triangles are 254 and 255.
const uint KIND_SPHERE = 0;
const uint KIND_BOX = 1;
