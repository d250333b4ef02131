// Taught by 47_normal_maps.
//
// The slope that a normal map has at a hit, for a closest hit shader: its built-in variables say where the instance
// lies.
#include "tangents.glsl"

// Added to the normal of the hit, it gives the mapped one, and lies across it. `normal` is the one to shade with, on
// the side that is seen.
vec3 slope_at(InstanceRecord instance, uint triangle, Surface surface, NormalMapRecord map, vec3 normal) {
    uvec3 corner = instance.triangles.at[triangle];
    Vertex a = instance.vertices.at[corner.x];
    Vertex b = instance.vertices.at[corner.y];
    Vertex c = instance.vertices.at[corner.z];
    mat3 to_world = mat3(gl_ObjectToWorldEXT);
    mat2x3 sides = mat2x3(to_world * (b.position - a.position), to_world * (c.position - a.position));
    mat2x3 axes = texture_axes(sides, mat2(b.uv - a.uv, c.uv - a.uv), normal);
    vec3 texel = textureLod(textures[nonuniformEXT(map.number)], surface.uv, 0.0).xyz;
    // The map is made for the other side if the normal was turned: seen from behind, bumps are dents.
    bool is_behind = dot(vec3(surface.normal * gl_WorldToObjectEXT), normal) < 0.0;
    return axes * texel_slope(texel, is_behind ? -map.scale : map.scale);
}
