// What the shaders of this chapter share: the push constants, what `show` may be, and the path.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/light.glsl"
#include "common/random.glsl"
#include "common/plane.glsl"
#include "common/checker.glsl"

// What lies on the plane: squares, or one colour.
struct Board {
    vec3 light;          // linear RGB
    vec3 dark;
    vec3 inner;          // of the plane seen from inside, where `inside` says so
    float specular;
    float roughness;
    float reflection;    // what it mirrors when looked at straight
    uint checker;
    float square;        // length of a square's side
    vec3 u;              // unit vectors along the sides
    vec3 v;
    vec2 anchor;         // on which square the plane's anchor lies
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Reflections { vec3 at[]; };

// ANCHOR: solids
struct Ball {
    vec3 center;
    float radius;
};

// A bound of a convex part: one side of a plane, or a ball.
struct Face {
    uint kind;
    uint index;
    float side;          // -1: the part lies where the plane's normal points
};

// A convex part: what lies within all of its faces.
struct Part {
    uint first_face;
    uint face_count;
    uint material;
};

// A solid: parts, and the steps that make one of them.
struct SolidRecord {
    uint first_part;
    uint part_count;
    uint first_step;
    uint step_count;
    uint clip;           // a part outside of which the surface is left out
    vec4 to_object[3];   // rows of the matrix from the world to the solid's space
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Planes { Plane at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Balls { Ball at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Faces { Face at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Parts { Part at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Steps { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SolidList { SolidRecord at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Solids {
    Planes planes;
    Balls balls;
    Faces faces;
    Parts parts;
    Steps steps;
    SolidList solids;
};

const uint FACE_PLANE = 0;
const uint FACE_BALL = 1;
const uint KIND_ENTERS = 0;    // hit kinds: the ray comes into the solid
const uint KIND_LEAVES = 1;
const uint NO_CLIP = 0xffffffffu;
const uint MAX_PARTS = 24;

// A step is the number of a part, or one of these.
const uint STEP_UNION = 64;
const uint STEP_INTERSECTION = 65;
const uint STEP_DIFFERENCE = 66;
const uint STEP_INVERSE = 67;
// ANCHOR_END: solids

struct Fog {
    vec3 color;
    float distance;      // after which 1/e of the light is left
};

// ANCHOR: world
// What is in the world beside the scene. It would not fit into push constants: 128 bytes are all that
// every device has.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer World {
    Reflections reflections;   // of each material, looked at straight
    Solids solids;
    Plane plane;
    Board board;
    uint inside;
    uint light_count;
    Light lights[2];
    Fog fog;
    uint first_solid;          // custom index of the first solid's instance
    uint solid_count;
    float section_distance;
};
// ANCHOR_END: world

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    World world;
    uint light_samples;   // shadow rays a hit, where the light has a size
    uint shadow_rays;
    uint smooth_terminator;
    uint depth;                   // how often a path may be reflected
    float minimum_contribution;
    uint origin;                  // one of the rules of common/origin.glsl
    uint bounce;                  // which ray of a path `show` looks at, 0 for the camera's
    uint show;
} push;

const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_SHADOW_ORIGIN = 6;
const uint SHOW_RAY_ORIGIN = 7;
const uint SHOW_RUNGS = 8;
const uint SHOW_SECTION = 9;
const uint SHOW_FOG = 10;

const uint SHADOW_FIRST_HIT = 0;
const uint SHADOW_NEAREST_HIT = 1;
const uint SHADOW_OFF = 2;

const uint INSIDE_NONE = 0;      // there is no plane
const uint INSIDE_SURFACE = 1;   // seen from both sides
const uint INSIDE_COLOR = 2;     // seen from inside in a colour of its own
const uint INSIDE_THROUGH = 3;   // seen from outside only

const uint CHECKER_FILTERED = 0;
const uint CHECKER_POINT = 1;
const uint CHECKER_OFF = 2;

// Compiled in, so that no shader of a loop holds a call to itself.
layout(constant_id = 0) const uint METHOD = 0;
const uint METHOD_ITERATIVE = 0;
const uint METHOD_RECURSIVE = 1;

layout(constant_id = 1) const uint PLANE_RUNG = PLANE_COMPENSATED;

// When the plane is tested.
layout(constant_id = 2) const uint PLANE_TEST = 0;
const uint PLANE_BEFORE = 0;
const uint PLANE_AFTER = 1;

// Where fog is: what a scene does not call for is not compiled.
layout(constant_id = 3) const uint FOG = 0;
const uint FOG_NONE = 0;
const uint FOG_EVERYWHERE = 1;
const uint FOG_OUTSIDE = 2;

// As far as rays go.
const float FAR = 1e30;

// ANCHOR: path
// What travels along a path: what it has gathered, and the next ray.
struct Path {
    vec4 color;
    vec3 throughput;   // what part of the light at the end of the next ray reaches the eye
    vec3 origin;
    float tmin;
    vec3 direction;
    uint bounce;       // the ray's number: 0 comes from the camera
    bool on_plane;     // the ray leaves the plane
    float plane;       // where the ray meets the plane; FAR if it does not
    float width;       // of what the pixel sees, where the ray begins
    float spread;      // by how much that widens in a unit of length
};

// ANCHOR: meet
// Where a ray meets the plane, FAR if it does not. A line meets a plane once: a ray that leaves it has
// nothing to ask, and needs no offset.
float meet_plane(vec3 origin, vec3 direction, float tmin, float tmax, bool on_plane) {
    Plane plane = push.world.plane;
    uint inside = push.world.inside;
    float t;
    if (inside == INSIDE_NONE || on_plane || !plane_by(PLANE_RUNG, plane, origin, direction, t)) {
        return FAR;
    }
    bool passes = inside == INSIDE_THROUGH && dot(direction, plane.normal) > 0.0;
    return t > tmin && t < tmax && !passes ? t : FAR;
}
// ANCHOR_END: meet

// Adds what a ray meets. The picture is the sum over the path; every other view shows one ray's.
void gather(inout Path path, vec4 seen) {
    if (push.show == SHOW_PICTURE) {
        path.color += vec4(path.throughput * seen.rgb, path.bounce == 0 ? seen.a : 0.0);
    } else if (path.bounce == push.bounce) {
        path.color = seen;
    }
}

// Whether the next ray is worth tracing.
bool goes_on(Path path) {
    float contribution = max(max(path.throughput.r, path.throughput.g), path.throughput.b);
    return path.bounce <= push.depth && contribution > 0.0
        && contribution >= push.minimum_contribution;
}
// ANCHOR_END: path

// A colour that differs from number to number (the finaliser of a 32-bit murmur hash).
vec3 false_color(uint number) {
    number = (number ^ (number >> 16)) * 0x85ebca6bu;
    number = (number ^ (number >> 13)) * 0xc2b2ae35u;
    number ^= number >> 16;
    return vec3(number & 0xffu, (number >> 8) & 0xffu, (number >> 16) & 0xffu) / 255.0;
}
