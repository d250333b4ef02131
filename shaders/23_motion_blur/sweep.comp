#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "common/scene.glsl"
#include "mover.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;

struct Bounds {
    vec3 low;
    vec3 high;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Boxes { Bounds at[]; };

layout(push_constant, scalar) uniform Sweeping {
    Movers movers;
    Instances instances;
    Boxes boxes;
    uint room;        // how many boxes each mover has room for
    float margin;     // how much larger a box is on each side
} sweep;

const float ROUNDING = 5.9604645e-8;

// The box around a triangle's way, whatever the time.
//
// A place goes straight, and a corner as seen from it along an arc. An arc of angle θ leaves its chord by the chord
// times tan(θ/4)/2, at most and to one side. So the arc is in the box of its ends, enlarged by that; and the way is in
// the sum of this box and that of the places.
Bounds swept(Mover mover, vec3 corners[3]) {
    mat3 open = rotation(mover.open_rotation);
    mat3 close = rotation(mover.close_rotation);
    // Of half the angle: a product of unit quaternions.
    float cosine = clamp(dot(mover.open_rotation, mover.close_rotation), 0.0, 1.0);
    float bulge = 0.5 * sqrt((1.0 - cosine) / (1.0 + cosine));
    Bounds arcs = Bounds(vec3(1e30), vec3(-1e30));
    float size = 0.0;
    for (int i = 0; i < 3; i++) {
        vec3 from = open * corners[i];
        vec3 to = close * corners[i];
        vec3 more = vec3(bulge * length(to - from));
        arcs.low = min(arcs.low, min(from, to) - more);
        arcs.high = max(arcs.high, max(from, to) + more);
        size = max(size, dot(abs(corners[i]), vec3(1.0)));
    }
    vec3 low = min(mover.open_place, mover.close_place);
    vec3 high = max(mover.open_place, mover.close_place);
    // The rounding here and when the triangle is moved is below 64 roundings of the largest number.
    size += max(dot(abs(low), vec3(1.0)), dot(abs(high), vec3(1.0)));
    vec3 room = vec3(sweep.margin + 64.0 * ROUNDING * size);
    return Bounds(low + arcs.low - room, high + arcs.high + room);
}

// One invocation for a box of a mover's room. What it does not need is a point, of which the intersection shader makes
// nothing. Boxes of NaN would be inactive; but with llvmpipe (Mesa 25.0.7) all boxes above them are lost, too.
void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= sweep.room) {
        return;    // the last workgroup reaches beyond the room
    }
    Mover mover = sweep.movers.at[at.y];
    Bounds bounds = Bounds(mover.open_place, mover.open_place);
    if (at.x < mover.triangles) {
        InstanceRecord instance = sweep.instances.at[mover.record];
        uvec3 corner = instance.triangles.at[instance.original.at[at.x]];
        vec3 corners[3];
        for (uint k = 0; k < 3; k++) {
            corners[k] = instance.vertices.at[corner[k]].position;
        }
        bounds = swept(mover, corners);
    }
    sweep.boxes.at[at.y * sweep.room + at.x] = bounds;
}
