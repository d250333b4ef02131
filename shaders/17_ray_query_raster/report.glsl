// The report on the surface that a pixel sees, found by the rasteriser or by a ray.
#include "push.glsl"
#include "common/hit.glsl"
#include "common/ray_offset.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// The texel of the G-buffer: four numbers of 32 bits.
struct Seen {
    uint instance;        // NOTHING for the sky
    uint triangle;        // of the model
    vec2 barycentrics;         // the second and the third barycentric coordinate
};

const uint NOTHING = 0xffffffff;

// The surface that was seen, and where: of the ray through the pixel's middle.
void report(inout Hit hit, Seen seen, vec3 ray) {
    mat4x3 to_world = push.placed.at[seen.instance].to_world;
    mat4x3 to_object = push.placed.at[seen.instance].to_object;
    InstanceRecord instance = push.scene.instances.at[seen.instance];
    Surface surface = surface_at(instance, seen.triangle, seen.barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    HitPoint at = hit_point(instance, seen.triangle, seen.barycentrics, to_world, to_object, ray);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = dot(hit.position - push.camera.origin, ray);
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * to_object));
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    hit.normal = faceforward(normal, -hit.face, normal);

    hit.color = material.base_color;
    if (material.base_texture >= 0) {
        hit.color *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    hit.material = instance.material;
    hit.triangle = seen.triangle;
    hit.instance = seen.instance;
}
