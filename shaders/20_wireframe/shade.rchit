#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#extension GL_EXT_ray_tracing_position_fetch : require
#include "push.glsl"
#include "line.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: the triangle's own normal, the material's colour, and the lines.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    MaterialRecord material = push.scene.materials.at[instance.material];
    vec3 corners[3] = gl_HitTriangleVertexPositionsEXT;
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 face = cross(corners[1] - corners[0], corners[2] - corners[0]);
    vec3 view = -gl_WorldRayDirectionEXT;
    vec3 normal = vec3(face * gl_WorldToObjectEXT);
    // A triangle may be so small that its area has no digits: then the side that the ray came from is up.
    normal = normalize(dot(normal, normal) > 1e-37 ? normal : view);
    normal = faceforward(normal, -view, normal);

    vec3 base = material.base_color;
    vec3 color = material.emission + base * ambient(normal);
    color += push.light.radiance
        * reflect_light(base, material.specular, material.shininess, normal, view, push.light.direction);

    if (SHOW == SHOW_LINES) {
        color = vec3(1.0);
    }
    if (SHOW == SHOW_NORMAL) {
        color = 0.5 + 0.5 * normal;
    }
    // ANCHOR: lines
    // Darker on a light surface, lighter on a dark one. The fourth number is the line's coverage.
    float coverage = line_coverage(barycentrics);
    float brightness = dot(color, vec3(0.2126, 0.7152, 0.0722));
    vec3 ink = brightness > 0.1 ? 0.15 * color : color + 0.2;
    if (SHOW == SHOW_LINES) {
        ink = vec3(0.0);
    }
    payload = vec4(mix(color, ink, coverage), coverage);
    // ANCHOR_END: lines
}
