#version 460
#ifdef BY_QUERY
#extension GL_EXT_ray_query : require
#endif
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Any rays, given and answered in buffers: by the walk, by every triangle in turn, or by the device.
#include "constants.glsl"
#include "walk.glsl"
#include "rays.glsl"

layout(local_size_x_id = 4, local_size_y_id = 5) in;

void visit(Trees trees, Node node, uint inside) {}

#ifdef BY_QUERY
layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

Answer answer(Given given) {
    rayQueryEXT query;
    uint flags = gl_RayFlagsOpaqueEXT | (given.any != 0 ? gl_RayFlagsTerminateOnFirstHitEXT : 0);
    rayQueryInitializeEXT(query, tlas, flags, 0xff, given.origin, 0.0, given.direction, given.tmax);
    while (rayQueryProceedEXT(query)) {}
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) {
        return Answer(given.tmax, NOTHING, 0, 0);
    }
    return Answer(rayQueryGetIntersectionTEXT(query, true),
        rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
        rayQueryGetIntersectionPrimitiveIndexEXT(query, true), 0);
}
#elif defined(BY_ALL)
// Every triangle of every instance: what any tree must not change.
Answer answer(Given given) {
    Answer answer = Answer(given.tmax, NOTHING, 0, 0);
    for (uint i = 0; i < launch.instances; i++) {
        Placed placed = launch.trees.at[0].placed.at[i];
        Ray ray = ray_in(placed, given.origin, given.direction);
        for (uint at = placed.first; at < placed.first + placed.count; at++) {
            float t = given.tmax;
            if (is_nearer(ray, launch.trees.at[0].corners.at[at], t)) {
                answer.count++;
                if (t < answer.t) {
                    answer = Answer(t, placed.number, at, answer.count);
                }
            }
        }
    }
    return answer;
}
#else
Answer answer(Given given) {
    // Two copies of the walk, each without what the other needs.
    Met met;
    if (given.any != 0) {
        met = walk(launch.trees.at[0], given.origin, given.direction, given.tmax, true);
    } else {
        met = walk(launch.trees.at[0], given.origin, given.direction, given.tmax, false);
    }
    uint number = met.placed == NOTHING ? NOTHING : launch.trees.at[0].placed.at[met.placed].number;
    return Answer(met.t, number, met.position, met.boxes + met.triangles);
}
#endif

void main() {
    uint at = gl_GlobalInvocationID.y * launch.across + gl_GlobalInvocationID.x;
    if (at < launch.rays) {
        launch.answers.at[at] = answer(launch.given.at[at]);
    }
}
