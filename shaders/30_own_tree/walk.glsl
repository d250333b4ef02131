// The walk of a ray through two levels of trees: what a ray query does on the device's own structure.
#include "tree.glsl"
#include "box.glsl"
#include "common/triangle.glsl"

// The nodes still to be visited, in one number: as a Child has it, `first` and, above these bits, `count`.
const uint FIRST_BITS = 28;
const uint FIRST_MASK = (1 << FIRST_BITS) - 1;

// The result of a ray: nothing, or a triangle of an instance.
struct Met {
    float t;
    uint placed;          // which instance, by its position in the top tree; NOTHING for a miss
    uint position;        // which triangle, by its position among all corners
    uint boxes;           // how many nodes it took, for views
    uint triangles;       // and how many triangles
};

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

uint entry_of(Child child) {
    return child.first | child.count << FIRST_BITS;
}

Ray ray_in(Placed placed, vec3 origin, vec3 direction) {
    vec3 o = placed.to_object * vec4(origin, 1.0);
    vec3 d = mat3(placed.to_object) * direction;
    return ray_through(o, d, GROWTH, placed.reach);
}

// Called at each node; what a view does there is the includer's.
void visit(Trees trees, Node node, uint inside);

// The nearest triangle that a ray meets with 0 < t < tmax, or, if `any` will do, the first one found.
Met walk(Trees trees, vec3 origin, vec3 direction, float tmax, const bool any) {
    Met met = Met(tmax, NOTHING, NOTHING, 0, 0);
    Ray ray = ray_through(origin, direction, trees.growth, trees.reach);
    uint inside = NOTHING;    // which instance the walk is in
    uint stack[STACK];
    uint height = 0;
    uint floor = 0;           // below it the stack belongs to the top tree
    uint entry = 0;           // the top tree's root
    while (true) {
        // ANCHOR: instance
        if (entry > FIRST_MASK && entry != NOTHING && inside == NOTHING) {
            // A leaf of the top tree: the walk goes into its first instance, and comes back for the others.
            inside = entry & FIRST_MASK;
            if (entry >> FIRST_BITS > 1) {
                stack[height++] = entry + 1 - (1 << FIRST_BITS);
            }
            floor = height;
            Placed placed = trees.placed.at[inside];
            ray = ray_in(placed, origin, direction);
            entry = placed.root;
        }
        // ANCHOR_END: instance
        // ANCHOR: node
        // Two nodes per turn, because most entries are nodes.
        for (uint step = 0; step < 2 && entry <= FIRST_MASK; step++) {
            Node node = QUANTISED ? unpacked(trees.packed.at[entry]) : node_at(trees.nodes, entry);
            met.boxes++;
            visit(trees, node, inside);
            float a = entered(ray, node.children[0], met.t);
            float b = entered(ray, node.children[1], met.t);
            uint near = b < a ? entry_of(node.children[1]) : entry_of(node.children[0]);
            uint far = b < a ? entry_of(node.children[0]) : entry_of(node.children[1]);
            // The near child comes first: a hit in it may spare the far one. The far one is always written,
            // but counts only if the ray enters both.
            stack[height] = far;
            height += a < MISSED && b < MISSED ? 1 : 0;
            entry = a < MISSED || b < MISSED ? near : NOTHING;
        }
        // ANCHOR_END: node
        // ANCHOR: leaf
        if (entry > FIRST_MASK && entry != NOTHING && inside != NOTHING) {
            uint first = entry & FIRST_MASK;
            uint end = first + (entry >> FIRST_BITS);
            for (uint position = first; position < end; position++) {
                met.triangles++;
                if (is_nearer(ray, trees.corners.at[position], met.t)) {
                    met.placed = inside;
                    met.position = position;
                }
            }
            entry = NOTHING;
        }
        // ANCHOR_END: leaf
        // ANCHOR: pop
        if (entry == NOTHING) {
            if (height == 0 || (any && met.placed != NOTHING)) {
                return met;
            }
            if (inside != NOTHING && height == floor) {
                inside = NOTHING;
                ray = ray_through(origin, direction, trees.growth, trees.reach);
            }
            entry = stack[--height];
        }
        // ANCHOR_END: pop
    }
}
