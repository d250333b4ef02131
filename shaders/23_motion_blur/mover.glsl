// The moving instances, and their place at a time while the shutter is open.

struct Mover {
    vec4 open_rotation;     // unit quaternions: axis times sine, and cosine, of half the angle
    vec4 close_rotation;
    vec3 open_place;
    vec3 close_place;
    uint record;            // which record of the scene's it has
    uint triangles;         // how many
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Movers { Mover at[]; };

layout(constant_id = 3) const uint BETWEEN = 0;
const uint BETWEEN_ROTATION = 0;
const uint BETWEEN_MATRIX = 1;

// ANCHOR: rotation
// The rotation of a quaternion of any length but 0. The length is divided out, so nothing shrinks.
mat3 rotation(vec4 q) {
    precise vec4 s = q * (2.0 / dot(q, q));
    precise vec3 x = vec3(1.0 - (q.y * s.y + q.z * s.z), q.x * s.y + q.w * s.z, q.x * s.z - q.w * s.y);
    precise vec3 y = vec3(q.x * s.y - q.w * s.z, 1.0 - (q.x * s.x + q.z * s.z), q.y * s.z + q.w * s.x);
    precise vec3 z = vec3(q.x * s.z + q.w * s.y, q.y * s.z - q.w * s.x, 1.0 - (q.x * s.x + q.y * s.y));
    return mat3(x, y, z);
}

// Where a mover is at a time: 0 when the shutter opens, 1 when it closes.
mat4x3 pose_at(Mover mover, float time) {
    precise vec3 place = mover.open_place + time * (mover.close_place - mover.open_place);
    precise vec4 q = mover.open_rotation + time * (mover.close_rotation - mover.open_rotation);
    mat3 turned = rotation(q);
    if (BETWEEN == BETWEEN_MATRIX) {
        mat3 open = rotation(mover.open_rotation);
        mat3 close = rotation(mover.close_rotation);
        for (int i = 0; i < 3; i++) {
            precise vec3 column = open[i] + time * (close[i] - open[i]);
            turned[i] = column;
        }
    }
    return mat4x3(turned[0], turned[1], turned[2], place);
}
// ANCHOR_END: rotation
