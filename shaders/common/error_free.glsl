// Taught by 24_accuracy.
//
// The error of a sum and of a product, as a float of its own.
//
// This needs `precise` and rounding to nearest. FUSED is whether fma() rounds once, which GLSL does not
// promise: a shader whose host has asked the device defines it before; 0 is right everywhere.
//
// SPIR-V has an instruction that must round once, OpFmaKHR, and GLSL has no word for it. The host defines FMA_KHR
// where the device offers it (VK_KHR_shader_fma).
#ifdef FMA_KHR
#extension GL_EXT_spirv_intrinsics : require
spirv_instruction(extensions = ["SPV_KHR_fma"], capabilities = [6030], id = 4427)
float fma_once(float a, float b, float c);
#undef FUSED
#define FUSED 1
#else
#define fma_once fma
#endif
#ifndef FUSED
#define FUSED 0
#endif

// Vulkan lets a device round up or down, unless a shader demands the nearest. GLSL has no word for that
// mode, so it is SPIR-V's. The host defines this macro where the device offers the mode; elsewhere
// the errors below are off by roundings of their own.
#ifdef ROUNDING_MODE_RTE
#extension GL_EXT_spirv_intrinsics : require
spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4467], 4462, 32);
#endif

// ANCHOR: exact
// a + b is sum.x + sum.y, exactly (Knuth).
vec2 two_sum(float a, float b) {
    precise float sum = a + b;
    precise float back = sum - a;
    precise float error = (a - (sum - back)) + (b - back);
    return vec2(sum, error);
}

// The upper 12 bits of a number and the lower 12: products of such halves are exact (Veltkamp).
vec2 split(float a) {
    precise float wide = 4097.0 * a;
    precise float high = wide - (wide - a);
    precise float low = a - high;
    return vec2(high, low);
}

// a·b is product.x + product.y, exactly: by an fma that rounds once, or from halves (Dekker).
vec2 two_product(float a, float b) {
    precise float product = a * b;
    if (FUSED != 0) {
        precise float error = fma_once(a, b, -product);
        return vec2(product, error);
    }
    vec2 x = split(a);
    vec2 y = split(b);
    precise float error = ((x.x * y.x - product) + x.x * y.y + x.y * y.x) + x.y * y.y;
    return vec2(product, error);
}
// ANCHOR_END: exact

// two_sum where |a| >= |b|, or a = 0 (Dekker).
vec2 quick_two_sum(float a, float b) {
    precise float sum = a + b;
    precise float error = b - (sum - a);
    return vec2(sum, error);
}

// start + a·b, where the error of each product and of each sum is kept, and added at the end.
// (Ogita, Rump and Oishi 2005, algorithm Dot2.)
float dot_compensated(vec2 start, vec3 a, vec3 b) {
    precise float sum = start.x;
    precise float error = start.y;
    for (int i = 0; i < 3; i++) {
        vec2 product = two_product(a[i], b[i]);
        vec2 next = two_sum(sum, product.x);
        sum = next.x;
        error += product.y + next.y;
    }
    precise float result = sum + error;
    return result;
}
