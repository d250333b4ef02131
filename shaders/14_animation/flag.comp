#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The flag at one moment: where each vertex is, and the normal of the cloth there.

layout(local_size_x_id = 0, local_size_y_id = 1) in;

struct Vertex {
    vec3 position;
    vec3 normal;
    vec2 uv;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Vertices { Vertex at[]; };

layout(push_constant, scalar) uniform Cloth {
    Vertices vertices;
    uvec2 cells;    // across and down
    vec2 size;
    float swing;    // how far it turns to either side, in radians
    float phase;    // how much of a wave has passed the pole, 0 to 1
} cloth;

const float WAVES = 2.5;    // along the cloth
const float LAG = 0.3;      // of a wave: the lower edge follows the upper one
const float SAG = 0.12;     // of the height: how far the free end hangs
const float TURN = 6.283185;    // no more than 2 pi

// Along the cloth its direction swings from side to side, as a river's does: then it is nowhere longer or
// shorter than it was, however far it swings (Langbein and Leopold 1966). So a vertex is reached by steps
// of one length, each in the direction of its middle, and two vertices of a row stay as far apart as they were.
void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThan(at, cloth.cells))) {
        return;    // the last workgroups reach beyond the cloth
    }
    vec2 uv = vec2(at) / vec2(cloth.cells);
    float step_length = cloth.size.x / float(cloth.cells.x);
    vec2 place = vec2(0.0);      // along the wind, and across it
    vec2 lower = vec2(0.0);      // how that changes on the way down
    vec2 way = vec2(1.0, 0.0);
    for (uint i = 0; i < at.x; i++) {
        float along = (float(i) + 0.5) / float(cloth.cells.x);
        // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
        float wave = TURN * (fract(WAVES * along - cloth.phase + LAG * uv.y + 0.5) - 0.5);
        float angle = cloth.swing * sin(wave);
        way = vec2(cos(angle), sin(angle));
        place += step_length * way;
        lower += step_length * cloth.swing * cos(wave) * TURN * LAG * vec2(-way.y, way.x);
    }
    float fall = SAG * uv.x * uv.x;
    Vertex vertex;
    vertex.position = vec3(place.x, -cloth.size.y * (uv.y + fall), place.y);
    vec3 across = vec3(way.x, -2.0 * cloth.size.y * SAG * uv.x / cloth.size.x, way.y);
    vec3 down = vec3(lower.x, -cloth.size.y, lower.y);
    vertex.normal = normalize(cross(down, across));
    vertex.uv = uv;
    cloth.vertices.at[at.y * (cloth.cells.x + 1) + at.x] = vertex;
}
