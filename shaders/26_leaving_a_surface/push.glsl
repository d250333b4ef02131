// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/show.glsl"

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    DirectionalLight light;
    uint depth;           // how often a path may be reflected
    float minimum_contribution;
    uint bounce;          // which ray of a path `show` looks at, 0 for the camera's
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_RAY_ORIGIN = 7;

layout(constant_id = 1) const uint ORIGIN = 5;
const uint ORIGIN_NOTHING = 0;
const uint ORIGIN_TMIN = 1;
const uint ORIGIN_NORMAL = 2;
const uint ORIGIN_INTEGERS = 3;
const uint ORIGIN_REPROJECTED = 4;
const uint ORIGIN_BOUND = 5;
const uint ORIGIN_OFFSET = 6;
const uint ORIGIN_MAGNITUDES = 7;
