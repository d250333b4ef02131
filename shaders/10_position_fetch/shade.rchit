#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#extension GL_EXT_ray_tracing_position_fetch : require
#include "push.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT vec4 payload;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: normal, material and light give the colour.
void main() {
    // ANCHOR: corners
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    MaterialRecord material = push.scene.materials.at[instance.material];
    // Object space, in the order of the indices that the build was given.
    vec3 corners[3];
    Surface surface;
    if (POSITIONS == POSITIONS_STRUCTURE) {
        corners = gl_HitTriangleVertexPositionsEXT;
        surface = surface_at(corners, push.meshes.at[instance.mesh], instance.triangles.at[triangle], barycentrics);
    } else {
        corners = corners_at(instance, triangle);
        surface = surface_at(instance, triangle, barycentrics);
    }
    // ANCHOR_END: corners
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    vec3 view = -gl_WorldRayDirectionEXT;
    // The flat triangle decides which side the ray sees: near an outline the smooth normal may look away.
    vec3 face = vec3(surface.face * gl_WorldToObjectEXT);
    normal = faceforward(normal, -faceforward(face, -view, face), normal);

    vec3 base = material.base_color;
    if (material.base_texture >= 0) {
        base *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    vec3 light = push.light.direction;
    vec3 color = material.emission + base * ambient(normal);
    color += push.light.radiance
        * reflect_light(base, material.specular, material.shininess, normal, view, light);

    payload = vec4(color, 1.0);
    if (SHOW == SHOW_NORMAL) {
        payload.rgb = 0.5 + 0.5 * normal;
    }
    if (SHOW == SHOW_GEOMETRIC) {
        // A triangle may be so small that its area has no digits.
        vec3 up = dot(face, face) > 1e-37 ? face : view;
        payload.rgb = 0.5 + 0.5 * normalize(faceforward(up, -view, up));
    }
    if (SHOW == SHOW_TRIANGLE) {
        payload.rgb = false_color(triangle);
    }
    if (SHOW == SHOW_HIT) {
        payload = vec4(gl_InstanceCustomIndexEXT, triangle, gl_HitTEXT, gl_InstanceID);
    }
    if (SHOW == SHOW_DIRECTION) {
        payload = vec4(gl_WorldRayDirectionEXT, gl_HitTEXT);
    }
    if (SHOW == SHOW_HIT_POINT) {
        payload = vec4(gl_ObjectToWorldEXT * vec4(point_at(corners, barycentrics), 1.0), gl_HitTEXT);
    }
    if (SHOW == SHOW_RAY_POINT) {
        payload = vec4(gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT, gl_HitTEXT);
    }
}
