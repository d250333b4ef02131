// The report of a hit shader on the surface a ray hit: the payload of the raygen shader's rays. The raygen
// shader decides what follows. It has the fields of the effects in use, and no more.

struct Hit {
    vec3 position;    // on the surface, in the world; of a miss, in x, how likely a shadow ray goes there
    float t;          // the distance along the ray; -1 for a miss
    vec3 normal;      // the normal to shade with: unit, on the side that the ray came from
    uint material;    // push.scene.materials.at[material], or MATERIAL_PLANE or MATERIAL_GROUND
    vec3 color;       // the material's colour, its texture already read; of a material with a pattern, the
                      // position in the mesh's own space, from which raygen computes it; for a miss, the sky's
#ifdef DEPARTURES
    float offset;     // start a ray this far along `face`: it is above the surface
    vec3 face;        // the surface's own normal: unit, on the same side
#endif
#ifdef TERMINATOR
    vec3 terminator_offset;  // from the flat triangle to the round surface that its normals pretend
#endif
#ifdef ROUGH_TEXTURES
    uint rough;       // what textures multiply roughness and metalness by, packed; of a material with such textures
#endif
#ifdef EFFECT_GLASS
    bool entering;    // the ray came from outside the body
#endif
#ifdef CHANCES
    uint emitter;     // number of the emitter, or NO_EMITTER
#endif
#ifdef CURVES
    float curvature;  // turn of the normal per unit of length
#endif
#ifdef TOLD_CONES
    vec2 cone;        // in: the ray's width and spread. Out, in x: the part that lines cover
#endif
#ifdef EFFECT_HISTORY
    uint surface;     // which it is, from the top: 16 bits; 8 that are 0; and how much it bends, 8 bits
#endif
};                    // 44 to 100 bytes

// The ground and the plane are made of nothing that is in the list of materials.
const uint MATERIAL_GROUND = -2;
const uint MATERIAL_PLANE = -1;

#ifdef EFFECT_HISTORY
// The surfaces of history that are not placed meshes: shapes from here on, the ground and the plane.
const uint SURFACE_SHAPE = 0x8000;
const uint SURFACE_GROUND = 0xfffd;
const uint SURFACE_PLANE = 0xfffe;
#endif

// The number of a surface whose light no shadow ray samples.
const uint NO_EMITTER = -1;
