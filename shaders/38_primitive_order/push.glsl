// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/false_color.glsl"
#include "common/heat.glsl"
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

// A box of the tree that halves the list.
struct Node {
    vec3 low;
    vec3 high;
    uint next;             // the node that comes after all that this box holds
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Tree { Node at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShapeAddresses {
    Spheres spheres;
    Boxes boxes;
    Original sphere_ids;   // primitive i of the build is sphere sphere_ids.at[i]
    Original box_ids;
    Spheres built_spheres; // primitive i of the build, without asking which sphere that is
    Boxes built_boxes;
    Tree tree;             // of all spheres, and behind it that of all boxes
    uint nodes;
    uint sphere_count;
    uint box_count;
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    ShapeAddresses shapes;
    DirectionalLight light;
} push;

// Views of this chapter, beside those of common/show.glsl.
const uint SHOW_KIND = 7;
const uint SHOW_PLACE = 8;
const uint SHOW_TESTS = 9;

// A scene says whether its shadows are worth their time.
layout(constant_id = 1) const bool SHADOWS = true;

// Hit kinds of intersection shaders go from 0 to 127; those of triangles are 254 and 255.
const uint KIND_SPHERE = 0;
const uint KIND_BOX = 1;

// ANCHOR: copies
// Reads the shapes from copies in the order of the build.
layout(constant_id = 2) const bool COPIES = false;

Sphere sphere_of(uint primitive) {
    if (COPIES) {
        return push.shapes.built_spheres.at[primitive];
    }
    return push.shapes.spheres.at[push.shapes.sphere_ids.at[primitive]];
}

Box box_of(uint primitive) {
    if (COPIES) {
        return push.shapes.built_boxes.at[primitive];
    }
    return push.shapes.boxes.at[push.shapes.box_ids.at[primitive]];
}
// ANCHOR_END: copies
