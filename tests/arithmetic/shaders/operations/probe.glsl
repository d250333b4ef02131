// One operation on many operands.
layout(buffer_reference, scalar) readonly buffer Operands { vec3 at[]; };
layout(buffer_reference, scalar) writeonly buffer Results { float at[]; };

layout(push_constant, scalar) uniform Push {
    Operands operands;
    Results results;
} push;

layout(constant_id = 0) const uint OPERATION = 0;

float result(float x, float y, float z) {
    precise float exact = 0.0;
    switch (OPERATION) {
        case 0: exact = x + y; return exact;
        case 1: exact = x - y; return exact;
        case 2: exact = x * y; return exact;
        case 3: return x / y;
        case 4: return sqrt(x);
        case 5: return inversesqrt(x);
        case 6: return exp2(x);
        case 7: return exp(x);
        case 8: return log2(x);
        case 9: return log(x);
        case 10: return sin(x);
        case 11: return cos(x);
        case 12: return atan(x);
        case 13: return atan(x, y);
        case 14: return pow(x, y);
        case 15: return x * y + z;
        case 16: return x + y - x;
        case 17: return length(vec3(x, y, z));
        case 18: return isnan(x / y) ? 1.0 : 0.0;
        // The same quotient in two places.
        case 19: exact = x / y - x / y; return exact;
        default: return float(floatBitsToUint(x));
    }
}

void main() {
    uint i = gl_LaunchIDEXT.x;
    vec3 operands = push.operands.at[i];
    push.results.at[i] = result(operands.x, operands.y, operands.z);
}
