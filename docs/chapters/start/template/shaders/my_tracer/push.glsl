// What the shaders share. The files in `common/` are those of the book.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    float radius;
} push;

// What a ray has met.
struct Hit {
    vec3 color;
    vec3 normal;
    float t;      // -1: nothing
};
