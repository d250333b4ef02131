// What the shaders of this chapter share: the push constants, the world behind them, and the path.
#include "effects.glsl"
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/random.glsl"
#include "common/plane.glsl"
#include "common/checker.glsl"
#include "common/heightfield.glsl"

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

// A convex solid: what is inside all of its faces.
struct Solid {
    vec3 center;
    uint first;      // of its faces
    uint count;
    uint material;
};

struct Face {
    vec3 normal;
    float distance;  // from the solid's center
};

// What lies on the plane.
struct Board {
    vec3 light;
    vec3 dark;
    float reflection;
    float square;    // length of a square's side
    vec3 u;          // unit vectors along the sides
    vec3 v;
    vec2 anchor;     // on which square the plane's anchor lies
};

struct Ground {
    HeightfieldShape shape;
    vec3 low;
    vec3 high;
    float error;     // by how much a height above the ground may be wrong that is computed in the box
    vec3 light;
    vec3 dark;
    vec3 rock;
    float square;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Spheres { Sphere at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Boxes { Box at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Solids { Solid at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Faces { Face at[]; };

const uint MAX_LIGHTS = 4;

// ANCHOR: world
// Everything that a scene may have. What it has not is empty: a program that knows nothing of the scene
// has to look.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer World {
    Spheres spheres;
    Boxes boxes;
    Solids solids;
    Faces faces;
    Plane plane;
    Board board;
    Ground ground;
    Light lights[MAX_LIGHTS];
    uint light_count;
    uint shadows;         // bit i: light i casts shadows
    uint light_samples;   // shadow rays a hit, to a light that has a size
    uint samples;         // rays a pixel
    uint depth;           // how often a path may be reflected
    uint plane_on;
};
// ANCHOR_END: world

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    World world;
} push;

// ANCHOR: constants
// Which kinds of light there are, one bit a kind; how many lights at most; which kinds of geometry rays
// look at. The compiler drops what such a constant rules out.
layout(constant_id = 0) const uint LIGHT_KINDS = 3;
layout(constant_id = 1) const uint LIGHTS = 4;
layout(constant_id = 2) const uint RAY_MASK = 0xff;
// ANCHOR_END: constants

// As far as rays go.
const float FAR = 1e30;
// What a path must still be able to add to a pixel.
const float MINIMUM_CONTRIBUTION = 1.0 / 512.0;

// ANCHOR: path
// What travels along a path: no more than the effects in use have to say to each other.
struct Path {
    vec3 color;
#ifdef EFFECT_MIRROR
    vec3 throughput;   // what part of the light at the end of the next ray reaches the eye
    vec3 origin;       // of the next ray
    vec3 direction;
    uint bounce;       // its number: 0 comes from the camera
#endif
#ifdef EFFECT_PLANE
    float plane;       // where the ray meets the plane; FAR if it does not
#ifdef EFFECT_MIRROR
    bool on_plane;     // the ray leaves the plane
#endif
#endif
#ifdef SQUARES
    float spread;      // by how much what the pixel sees widens in a unit of length
#ifdef EFFECT_MIRROR
    float width;       // how wide it is where the ray begins
#endif
#endif
#ifdef SAMPLE_NUMBERS
    uint number;       // which of the pixel's samples this is
#endif
};
// ANCHOR_END: path

// ANCHOR: flags
// What every ray is told: without cut-outs, no any-hit shader is to be looked for.
#ifdef EFFECT_CUT_OUT
const uint RAY_FLAGS = gl_RayFlagsNoneEXT;
#else
const uint RAY_FLAGS = gl_RayFlagsOpaqueEXT;
#endif
// ANCHOR_END: flags

#ifdef EFFECT_PLANE
// Where a ray meets the plane, FAR if it does not. A line meets a plane once: a ray that leaves it has
// nothing to ask.
float meet_plane(vec3 origin, vec3 direction, float tmax, bool on_plane) {
    float t;
    if (push.world.plane_on == 0 || on_plane
        || !plane_compensated(push.world.plane, origin, direction, t)) {
        return FAR;
    }
    return t > 0.0 && t < tmax ? t : FAR;
}
#endif

#ifdef EFFECT_MIRROR
// Whether the next ray is worth tracing.
bool goes_on(Path path) {
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    return path.bounce <= push.world.depth && contribution >= MINIMUM_CONTRIBUTION;
}
#endif

// Adds what the ray has met.
void gather(inout Path path, vec3 seen) {
#ifdef EFFECT_MIRROR
    path.color += path.throughput * seen;
#else
    path.color = seen;
#endif
}
