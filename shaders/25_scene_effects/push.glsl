// The push constants of this chapter's shaders, the world behind their addresses, and the
// specialization constants.
#include "effects.glsl"
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/disk.glsl"
#include "common/random.glsl"
#include "common/plane.glsl"
#include "common/checker.glsl"
#include "common/heightfield.glsl"
#include "common/glass.glsl"
#include "common/emitter.glsl"
#include "common/strand.glsl"
#include "common/torus.glsl"
#include "common/rough.glsl"
#include "common/normal_map.glsl"
#include "common/sky.glsl"
#include "common/ray_time.glsl"
#include "lens.glsl"

// All that shines.
struct EmitterAddresses {
    Emitters emitters;    // spheres, then the triangles of each mesh that shines
    Columns columns;
    Numbers first;        // of each instance: which emitter its triangle 0 is
    Numbers sphere_ids;   // of each sphere of the build: which emitter it is
    uint count;           // of the emitters
    uint column_count;    // a power of two, or 0 where nothing shines
};

struct Sphere {
    vec3 center;
    float radius;
    uint material;
    vec3 moves;      // by so much while the shutter is open
};

// Where a sphere is at a time: where it stands, to the bit, if it does not move.
vec3 center_at(Sphere sphere, float time) {
#ifdef EFFECT_MOTION_BLUR
    precise vec3 center = sphere.center + time * sphere.moves;
    return center;
#else
    return sphere.center;
#endif
}

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

// The surface of the plane.
struct Board {
    vec3 light;
    vec3 dark;
    float reflection;
    float square;    // length of a square's side
    vec3 u;          // unit vectors along the sides
    vec3 v;
    vec2 anchor;     // on which square the plane's anchor lies
};

// The data of a material that an MTL file cannot hold.
struct Finish {
    vec3 second;     // the colour where the pattern is 1; where it is 0, the material's own is seen
    float scale;     // cells of the pattern's lattice a unit
    vec3 ink;        // the colour of lines
    float lines;     // how wide they are, in pixels; 0 for none
    uint pattern;
    uint blended;    // the alpha of its texture is how much of it is there, not where it has holes
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
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Finishes { Finish at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Glasses { Glass at[]; };

const uint MAX_LIGHTS = 4;

// Everything that a scene may have. What it has not is empty: a program that knows nothing of the scene
// has to look.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer World {
    Spheres spheres;
    Boxes boxes;
    Solids solids;
    Faces faces;
    Nodes nodes;          // of all strands
    Segments segments;
    Finishes finishes;
    Glasses glasses;
    NormalMaps normal_maps;
    EmitterAddresses emitters;
    Plane plane;
    Board board;
    Ground ground;
    Lens lens;
    uint media[4];        // the bodies of glass that the camera is in
    DiskLight lights[MAX_LIGHTS];
    float sky;            // how bright it is, 0 to 1; 0 if it is a picture
    float rotation;       // of the picture around the vertical, in turns
    uint sky_on;          // whether there is a picture of the sky
    uint light_count;
    uint shadows;         // bit i: light i casts shadows
    uint light_samples;   // shadow rays a hit, to a light that has a size
    uint samples;         // rays per pixel
    uint first_sample;    // the number of the first
    uint depth;           // how often a path may be reflected or refracted
    uint bounces;         // how often it may be scattered
    uint plane_on;
    uint finish_count;    // of materials, if one in use has a finish; else 0
    uint glass_count;     // of materials, if one in use is glass; else 0
    uint rough_count;     // of materials, if one in use has microfacets; else 0
    uint map_count;       // of materials, if one in use has a normal map; else 0
    uint moving;          // whether anything moves while the shutter is open
    Tori tori;
    uint filtered;        // whether textures are averaged over what a pixel sees
};

// The time of each pixel, in ticks of the device's clock.
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Ticks { uint at[]; };

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    World world;
    RoughAddresses rough;
    SkyAddresses sky;
    Ticks ticks;
    float hottest;        // the ticks that are shown in white
} push;

// The kinds of light, one bit per kind; the largest number of lights; the kinds of geometry that rays
// test; the patterns, one bit each. The compiler drops the code that such a constant rules out.
layout(constant_id = 0) const uint LIGHT_KINDS = 3;
layout(constant_id = 1) const uint LIGHTS = 4;
layout(constant_id = 2) const uint RAY_MASK = 0xff;
layout(constant_id = 3) const uint PATTERNS = 14;

// The flags of every ray: if nothing is seen through, the device need not look for an any-hit shader.
#ifdef SEEN_THROUGH
const uint RAY_FLAGS = gl_RayFlagsNoneEXT;
#else
const uint RAY_FLAGS = gl_RayFlagsOpaqueEXT;
#endif

// The picture chooses the directions of shadow rays.
const uint SAMPLER = 2;
const uint SAMPLER_UNIFORM = 1;

// As far as rays go.
const float FAR = 1e30;
