// Selects the code to compile. The program defines EFFECT_... for each effect in use, and SPECIALISED.
//
// Alone, as tests and editors compile it, a shader has everything.

#ifndef SPECIALISED
#define EFFECT_TRIANGLES
#define EFFECT_TEXTURES
#define EFFECT_FILTERED_TEXTURES
#define EFFECT_NORMAL_MAPS
#define EFFECT_CUT_OUT
#define EFFECT_BLENDED
#define EFFECT_SPHERES
#define EFFECT_BOXES
#define EFFECT_SWEPT_SPHERES
#define EFFECT_HEIGHTFIELD
#define EFFECT_PLANE
#define EFFECT_SOLIDS
#define EFFECT_TORI
#define EFFECT_POINT_SHADOWS
#define EFFECT_DIRECTIONAL_SHADOWS
#define EFFECT_AREA_LIGHT
#define EFFECT_MIRROR
#define EFFECT_ROUGH_METAL
#define EFFECT_BOUNCES
#define EFFECT_GLASS
#define EFFECT_EMITTERS
#define EFFECT_ENVIRONMENT
#define EFFECT_PATTERNS
#define EFFECT_WIREFRAME
#define EFFECT_ANTI_ALIASING
#define EFFECT_DEPTH_OF_FIELD
#define EFFECT_MOTION_BLUR
#define EFFECT_HISTORY
#endif

// Needed by several effects.
#if defined(EFFECT_CUT_OUT) || defined(EFFECT_BLENDED)
#define SEEN_THROUGH
#endif
#if defined(EFFECT_POINT_SHADOWS) || defined(EFFECT_DIRECTIONAL_SHADOWS)
#define SHADOWS
#endif
#if defined(SHADOWS) || defined(EFFECT_EMITTERS) || defined(EFFECT_ENVIRONMENT)
#define SHADOW_RAYS
#endif
// Surfaces that send a ray on: a path has several.
#if defined(EFFECT_MIRROR) || defined(EFFECT_ROUGH_METAL) || defined(EFFECT_BOUNCES) || defined(EFFECT_GLASS)
#define PATHS
#endif
// Surfaces that send it on in one of many directions.
#if defined(EFFECT_ROUGH_METAL) || defined(EFFECT_BOUNCES)
#define RANDOM_DIRECTIONS
#endif
// Light that shadow rays look for in one direction of many.
#if defined(EFFECT_EMITTERS) || defined(EFFECT_ENVIRONMENT)
#define SAMPLED_LIGHT
#endif
// Paths find the same light at random.
#if defined(SAMPLED_LIGHT) && defined(RANDOM_DIRECTIONS)
#define FOUND_TWICE
#endif
// Emitters are found in two ways: by shadow rays, and by rays in random directions.
#if defined(EFFECT_EMITTERS) && defined(RANDOM_DIRECTIONS)
#define CHANCES
#endif
// Surfaces that rays leave again: only there does it matter where exactly a ray starts. History compares what such
// surfaces report.
#if defined(SHADOW_RAYS) || defined(PATHS) || defined(EFFECT_HISTORY)
#define DEPARTURES
#endif
// Triangles that stand for a round surface: a shadow ray leaves that.
#if defined(SHADOWS) && defined(EFFECT_TRIANGLES)
#define TERMINATOR
#endif
// Without textures there is nothing to filter.
#ifndef EFFECT_TEXTURES
#undef EFFECT_FILTERED_TEXTURES
#endif
// Roughness and metalness from textures.
#if defined(EFFECT_ROUGH_METAL) && defined(EFFECT_TEXTURES)
#define ROUGH_TEXTURES
#endif
// Triangles whose looks depend on how much of them a pixel sees: they are told the ray's cone.
#if defined(EFFECT_WIREFRAME) || defined(EFFECT_FILTERED_TEXTURES)
#define TOLD_CONES
#endif
// Squares, averaged over what a pixel sees of them, lines as wide as pixels, filtered textures: a ray has a cone.
#if defined(EFFECT_PLANE) || defined(EFFECT_HEIGHTFIELD) || defined(TOLD_CONES)
#define CONES
#endif
// A curved mirror changes the cone, and so does metal or glass that mirrors.
#if defined(CONES) && (defined(EFFECT_MIRROR) || defined(EFFECT_ROUGH_METAL) || defined(EFFECT_GLASS))
#define CURVES
#endif
// The data of a material that an MTL file cannot hold.
#if defined(EFFECT_PATTERNS) || defined(EFFECT_WIREFRAME)
#define FINISHES
#endif
