// Taught by 05_shadow_miss.
//
// The report of a hit shader on the surface a ray hit: the payload of the raygen shader's rays.
// The raygen shader decides what follows.

struct Hit {
    vec3 position;    // on the surface, in the world
    float offset;     // start a ray this far along `face`: it is above the surface
    vec3 face;        // the triangle's own normal: unit, on the side that the ray came from
    float t;          // the distance along the ray; -1 if the ray met nothing
    vec3 normal;      // the normal to shade with: unit, on the same side
    uint material;    // which material: push.scene.materials.at[material]
    vec3 color;       // the material's colour, its texture already read; for a miss, the sky's
    uint triangle;    // which triangle of the model
    uint instance;    // which instance: gl_InstanceCustomIndexEXT
};                    // 68 bytes
