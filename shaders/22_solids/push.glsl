// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/plane.glsl"
#include "common/show.glsl"

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
    SolidList at;
    uint first;          // custom index of the first solid's instance
    uint count;
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

struct Fog {
    vec3 color;
    float distance;      // after which 1/e of the light is left
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    Solids solids;
    DirectionalLight light;
    Fog fog;
    float section_distance;
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_KIND = 7;
const uint SHOW_SECTION = 8;
const uint SHOW_FOG = 9;

// The method for half-spaces.
layout(constant_id = 1) const uint RUNG = 2;
const uint RUNG_POV = 0;
const uint RUNG_POINT = 1;
const uint RUNG_COMPENSATED = 2;

// Where fog is: what a scene does not call for is not compiled.
layout(constant_id = 2) const uint FOG = 0;
const uint FOG_NONE = 0;
const uint FOG_EVERYWHERE = 1;
const uint FOG_OUTSIDE = 2;

// As far as rays go.
const float FAR = 1e30;
