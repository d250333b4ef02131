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
        case 20: return tan(x);
        case 21: return asin(x);
        case 22: return acos(x);
        case 23: return mix(x, y, z);
        case 24: return smoothstep(x, y, z);
        case 25: return refract(vec2(x, y), vec2(0.0, 1.0), z).y;
        case 26: return mod(x, y);
        case 27: return min(x, y);
        case 28: return max(x, y);
        case 29: return clamp(x, y, z);
        default: return float(floatBitsToUint(x));
    }
}

void main() {
    uint i = gl_LaunchIDEXT.x;
    vec3 operands = push.operands.at[i];
    push.results.at[i] = result(operands.x, operands.y, operands.z);
}
