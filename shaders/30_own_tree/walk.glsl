// The walk of a ray through two levels of trees: what a ray query does on the device's own structure.
#include "tree.glsl"
#include "box.glsl"
#include "common/triangle.glsl"

const uint NOTHING = 0xffffffff;
// What is left to be visited, in one number: as a Child has it, `first` and, above these bits, `count`.
const uint FIRST_BITS = 28;
const uint FIRST_MASK = (1 << FIRST_BITS) - 1;

// ANCHOR: met
// What a ray has met: nothing, or a triangle of an instance.
struct Met {
    float t;
    uint placed;          // which instance, by its position in the top tree; NOTHING for a miss
    uint position;        // which triangle, by its position among all corners
    uint boxes;           // how many nodes it took, for views
    uint triangles;       // and how many triangles
};
// ANCHOR_END: met

// ANCHOR: triangle
// Where the ray of a tree meets a triangle, if that is nearer than all before.
bool is_nearer(Ray ray, Corners corners, inout float nearest) {
    float t;
    bool hit;
    if (TRIANGLES == TRIANGLES_MOELLER) {
        hit = triangle_moeller(corners.a, corners.b, corners.c, ray.origin, ray.direction, t);
    } else if (TRIANGLES == TRIANGLES_WATERTIGHT) {
        hit = triangle_woop(corners.a, corners.b, corners.c, ray.origin, ray.direction, t);
    } else {
        vec3 normal;
        hit = triangle_two_float(corners.a, corners.b, corners.c, ray.origin, ray.direction, 0.0, nearest,
            t, normal);
    }
    hit = hit && t > 0.0 && t < nearest;
    nearest = hit ? t : nearest;
    return hit;
}
// ANCHOR_END: triangle

uint packed(Child child) {
    return child.first | child.count << FIRST_BITS;
}

Ray ray_in(Placed placed, vec3 origin, vec3 direction) {
    vec3 o = placed.to_object * vec4(origin, 1.0);
    vec3 d = mat3(placed.to_object) * direction;
    return ray_through(o, d, GROWTH, placed.reach);
}

// Called at each node; what a view does there is the includer's.
void visit(Trees trees, Node node, uint inside);

// ANCHOR: walk
// The nearest triangle that a ray meets with 0 < t < tmax, or, if `any` will do, the first one found.
Met walk(Trees trees, vec3 origin, vec3 direction, float tmax, const bool any) {
    Met met = Met(tmax, NOTHING, NOTHING, 0, 0);
    Ray ray = ray_through(origin, direction, trees.growth, trees.reach);
    uint stack[STACK];
    uint height = 0;
    uint floor = 0;                    // below it, the stack belongs to the top tree
    uint inside = NOTHING;             // which instance the walk is in
    uint entry = 0;                    // the top tree's root
    while (true) {
        uint first = entry & FIRST_MASK;
        uint count = entry >> FIRST_BITS;
        if (count == 0) {
            // ANCHOR: node
            Node node = trees.nodes.at[first];
            met.boxes++;
            visit(trees, node, inside);
            float a = entered(ray, node.children[0], met.t);
            float b = entered(ray, node.children[1], met.t);
            if (min(a, b) < MISSED) {
                uint near = packed(node.children[0]);
                uint far = packed(node.children[1]);
                // The near child comes first: what is found there may spare the far one.
                if (max(a, b) < MISSED) {
                    stack[height++] = b < a ? near : far;
                }
                entry = b < a ? far : near;
                continue;
            }
            // ANCHOR_END: node
        } else if (inside == NOTHING) {
            // ANCHOR: instance
            if (count > 1) {
                stack[height++] = (first + 1) | (count - 1) << FIRST_BITS;
            }
            inside = first;
            floor = height;
            Placed placed = trees.placed.at[first];
            ray = ray_in(placed, origin, direction);
            entry = placed.root;
            continue;
            // ANCHOR_END: instance
        } else {
            // ANCHOR: leaf
            for (uint position = first; position < first + count; position++) {
                met.triangles++;
                if (is_nearer(ray, trees.corners.at[position], met.t)) {
                    met.placed = inside;
                    met.position = position;
                }
            }
            if (any && met.placed != NOTHING) {
                return met;
            }
            // ANCHOR_END: leaf
        }
        // ANCHOR: pop
        if (inside != NOTHING && height == floor) {
            inside = NOTHING;
            ray = ray_through(origin, direction, trees.growth, trees.reach);
        }
        if (height == 0) {
            return met;
        }
        entry = stack[--height];
        // ANCHOR_END: pop
    }
}
// ANCHOR_END: walk
