// Taught by 02_basic.
//
// The extensions of GLSL that nearly every ray tracing stage needs; a stage that needs more lists it itself.
#extension GL_EXT_ray_tracing : require             // the stages, their built-in variables and traceRayEXT
#extension GL_EXT_buffer_reference2 : require       // pointers to buffers
#extension GL_EXT_scalar_block_layout : require     // structures packed as in Rust and C
#extension GL_EXT_nonuniform_qualifier : require    // an index into the textures that differs from ray to ray
