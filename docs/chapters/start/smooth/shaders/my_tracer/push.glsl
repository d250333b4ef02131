// The push constants of all shaders. The files in `common/` are the book's.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"

// A lamp, as main.rs declares it, and an address behind which lamps lie one after the other.
struct Lamp {
    vec3 position;
    vec3 intensity;    // what arrives at distance 1
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Lamps { Lamp at[]; };

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Lamps lamps;
    uint lamp_count;
    DirectionalLight sun;
    uint reflections;
    float moon;
    float radius;
    vec3 center;
    uint grid;    // rows of rays in a pixel
} push;
