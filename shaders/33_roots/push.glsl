// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"
#include "common/torus.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShapeAddresses {
    Tori tori;
    Original ids;   // primitive i of the build is torus ids.at[i]
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    ShapeAddresses shapes;
    DirectionalLight light;
} push;

// Hit kinds of intersection shaders go from 0 to 127; those of triangles are 254 and 255.
const uint KIND_TORUS = 0;
