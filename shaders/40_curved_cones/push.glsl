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
    uint rays;       // a pixel has so many times so many
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_COLOR = 7;
const uint SHOW_LEVEL = 8;

layout(constant_id = 1) const uint FOOTPRINT = 2;
const uint FOOTPRINT_POINT = 0;           // a point: level 0, whatever the distance
const uint FOOTPRINT_FLAT = 1;            // the ellipse of a cone, for which mirrors and glass are flat
const uint FOOTPRINT_CURVED = 2;          // the ellipse of a cone that curvature bends
const uint FOOTPRINT_DIFFERENTIALS = 3;   // from where the neighbouring pixels' rays would go
