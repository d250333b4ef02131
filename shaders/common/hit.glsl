// Taught by 05_shadow_miss.
//
// What the hit shader reports of the surface that a ray met: the payload of the raygen shader's rays.
// The raygen shader decides what to do about it.

struct Hit {
    vec3 position;    // on the surface, in the world
    float offset;     // a ray that starts so far along `face` is above the surface, wherever it goes
    vec3 face;        // the triangle's own normal: unit, on the side that the ray came from
    float t;          // the distance along the ray; -1 if the ray met nothing
    vec3 normal;      // the normal to shade with: unit, on the same side
    uint material;    // which material: push.scene.materials.at[material]
    vec3 color;       // the material's colour, its texture already read; for a miss, the sky's
    uint triangle;    // which triangle of the model
    uint instance;    // which instance: gl_InstanceCustomIndexEXT
};                    // 68 bytes
