// The execution modes that error-free transformations need: round to nearest even, zeros with signs.
// GLSL has no words for them, so they are SPIR-V's (SPV_KHR_float_controls).
#extension GL_EXT_spirv_intrinsics : require

// The rungs that need this are compiled with it alone.
#define EXACT

spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4466], 4461, 32);   // SignedZeroInfNanPreserve
spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4467], 4462, 32);   // RoundingModeRTE
