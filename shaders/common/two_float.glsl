// Taught by 24_accuracy.
//
// Two floats for one number: twice the bits, from 32-bit operations alone.
//
// Of two floats a + b, the sum's rounding error is itself a float, and can be computed; so it is with
// a·b. A two-float (ff_... below) is a vec2 whose x is a number rounded and whose y is what rounding
// left: about 48 bits. A sum of many terms is kept in three floats (sum_... below), about 72 bits, so
// that terms may cancel. (Dekker 1971; Knuth, TAOCP 2, 4.2.2; Ogita, Rump and Oishi 2005.)
//
// This needs rounding to nearest and `precise`. It trusts neither division nor sqrt, which Vulkan lets
// be off by 2.5 ULP and more: what they give is a first guess, and the exact remainder corrects it.

#include "common/error_free.glsl"

// Powers of two change no bit of a number but its exponent: a way out of the reach of overflow.

// 2^e for -126 <= e <= 127.
float power_of_two(int e) {
    return intBitsToFloat((e + 127) << 23);
}

// a·2^e, in two steps, since 2^e alone might not be a float.
float scaled(float a, int e) {
    e = clamp(e, -252, 252);
    int half_way = e / 2;
    precise float result = a * power_of_two(half_way) * power_of_two(e - half_way);
    return result;
}

vec2 scaled(vec2 a, int e) {
    return vec2(scaled(a.x, e), scaled(a.y, e));
}

vec3 scaled(vec3 a, int e) {
    return vec3(scaled(a.x, e), scaled(a.y, e), scaled(a.z, e));
}

// e, where 2^e <= |a| < 2^(e + 1); of zero, -127.
int exponent_of(float a) {
    return ((floatBitsToInt(a) >> 23) & 255) - 127;
}

int exponent_of(vec3 a) {
    return exponent_of(max(max(abs(a.x), abs(a.y)), abs(a.z)));
}

// A sum of many terms: what rounding leaves of the first float goes to the second, and what it leaves
// there to the third. The same terms with opposite signs, in the same order, give the opposite sum.
void sum_add(inout vec3 sum, float term) {
    vec2 first = two_sum(sum.x, term);
    vec2 second = two_sum(sum.y, first.y);
    precise float third = sum.z + second.y;
    sum = vec3(first.x, second.x, third);
}

void sum_add(inout vec3 sum, vec2 term) {
    sum_add(sum, term.x);
    sum_add(sum, term.y);
}

void sum_add_product(inout vec3 sum, float a, float b) {
    sum_add(sum, two_product(a, b));
}

void sum_add_product(inout vec3 sum, vec2 a, float b) {
    sum_add_product(sum, a.x, b);
    sum_add_product(sum, a.y, b);
}

void sum_add_product(inout vec3 sum, vec2 a, vec2 b) {
    sum_add_product(sum, a, b.x);
    sum_add_product(sum, a, b.y);
}

// The sum, rounded to a two-float.
vec2 sum_total(vec3 sum) {
    vec2 upper = two_sum(sum.x, sum.y);
    vec2 lower = two_sum(upper.y, sum.z);
    vec2 total = two_sum(upper.x, lower.x);
    precise float low = total.y + lower.y;
    return quick_two_sum(total.x, low);
}

vec2 ff_add(vec2 a, vec2 b) {
    vec2 high = two_sum(a.x, b.x);
    vec2 low = two_sum(a.y, b.y);
    precise float rest = high.y + low.x;
    vec2 sum = quick_two_sum(high.x, rest);
    precise float last = sum.y + low.y;
    return quick_two_sum(sum.x, last);
}

vec2 ff_sub(vec2 a, vec2 b) {
    return ff_add(a, -b);
}

vec2 ff_mul(vec2 a, vec2 b) {
    vec2 product = two_product(a.x, b.x);
    precise float low = product.y + (a.x * b.y + a.y * b.x);
    return quick_two_sum(product.x, low);
}

vec2 ff_mul(vec2 a, float b) {
    return ff_mul(a, vec2(b, 0.0));
}

// As in long division: each digit is a float, guessed from the remainder so far. b must not be 0.
vec2 ff_div(vec2 a, vec2 b) {
    vec3 remainder = vec3(a, 0.0);
    precise float first = a.x / b.x;
    sum_add_product(remainder, b, -first);
    precise float second = sum_total(remainder).x / b.x;
    sum_add_product(remainder, b, -second);
    precise float third = sum_total(remainder).x / b.x;
    vec2 quotient = quick_two_sum(first, second);
    precise float low = quotient.y + third;
    return quick_two_sum(quotient.x, low);
}

// Newton's method: half the remainder a - x², divided by x, is what x lacks. 0 if a is not positive.
vec2 ff_sqrt(vec2 a) {
    if (!(a.x > 0.0)) {
        return vec2(0.0);
    }
    precise float first = sqrt(a.x);
    precise float twice = 2.0 * first;
    vec3 remainder = vec3(a, 0.0);
    sum_add_product(remainder, first, -first);
    precise float second = sum_total(remainder).x / twice;
    sum_add_product(remainder, twice, -second);
    sum_add_product(remainder, second, -second);
    precise float third = sum_total(remainder).x / twice;
    vec2 root = quick_two_sum(first, second);
    precise float low = root.y + third;
    return quick_two_sum(root.x, low);
}

bool ff_less(vec2 a, vec2 b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// Within a ray's interval: tmin < t <= tmax.
bool ff_within(vec2 t, float tmin, float tmax) {
    return ff_less(vec2(tmin, 0.0), t) && !ff_less(vec2(tmax, 0.0), t);
}

struct TwoFloat3 {
    vec2 x;
    vec2 y;
    vec2 z;
};

TwoFloat3 ff_vector(vec3 a) {
    return TwoFloat3(vec2(a.x, 0.0), vec2(a.y, 0.0), vec2(a.z, 0.0));
}

// a - b, exactly.
TwoFloat3 ff_difference(vec3 a, vec3 b) {
    return TwoFloat3(two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.z, -b.z));
}

TwoFloat3 ff_sub(TwoFloat3 a, TwoFloat3 b) {
    return TwoFloat3(ff_sub(a.x, b.x), ff_sub(a.y, b.y), ff_sub(a.z, b.z));
}

TwoFloat3 ff_mul(TwoFloat3 a, vec2 b) {
    return TwoFloat3(ff_mul(a.x, b), ff_mul(a.y, b), ff_mul(a.z, b));
}

TwoFloat3 scaled(TwoFloat3 a, int e) {
    return TwoFloat3(scaled(a.x, e), scaled(a.y, e), scaled(a.z, e));
}

vec3 rounded(TwoFloat3 a) {
    return vec3(a.x.x, a.y.x, a.z.x);
}

// Its terms may cancel, as may those of the cross product.
vec2 ff_dot(TwoFloat3 a, TwoFloat3 b) {
    vec3 sum = vec3(0.0);
    sum_add_product(sum, a.x, b.x);
    sum_add_product(sum, a.y, b.y);
    sum_add_product(sum, a.z, b.z);
    return sum_total(sum);
}

vec2 ff_dot(TwoFloat3 a, vec3 b) {
    vec3 sum = vec3(0.0);
    sum_add_product(sum, a.x, b.x);
    sum_add_product(sum, a.y, b.y);
    sum_add_product(sum, a.z, b.z);
    return sum_total(sum);
}

// a·d - b·c. With (a, b) and (c, d) in each other's place, all terms come in the same order with the
// opposite sign; so does the result.
vec2 ff_determinant(vec2 a, vec2 b, vec2 c, vec2 d) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            vec2 plus = two_product(a[i], d[j]);
            vec2 minus = two_product(b[j], c[i]);
            sum_add(sum, two_sum(plus.x, -minus.x));
            sum_add(sum, two_sum(plus.y, -minus.y));
        }
    }
    return sum_total(sum);
}

vec2 ff_determinant(vec2 a, vec2 b, float c, float d) {
    vec3 sum = vec3(0.0);
    sum_add_product(sum, a, d);
    sum_add_product(sum, b, -c);
    return sum_total(sum);
}

TwoFloat3 ff_cross(TwoFloat3 a, TwoFloat3 b) {
    return TwoFloat3(
        ff_determinant(a.y, a.z, b.y, b.z),
        ff_determinant(a.z, a.x, b.z, b.x),
        ff_determinant(a.x, a.y, b.x, b.y));
}

TwoFloat3 ff_cross(TwoFloat3 a, vec3 b) {
    return TwoFloat3(
        ff_determinant(a.y, a.z, b.y, b.z),
        ff_determinant(a.z, a.x, b.z, b.x),
        ff_determinant(a.x, a.y, b.x, b.y));
}

// a / |a|, each component rounded once; zero if a is.
vec3 ff_normalize(TwoFloat3 a) {
    a = scaled(a, -exponent_of(rounded(a)));
    vec2 size = ff_sqrt(ff_dot(a, a));
    if (!(size.x > 0.0)) {
        return vec3(0.0);
    }
    return vec3(ff_div(a.x, size).x, ff_div(a.y, size).x, ff_div(a.z, size).x);
}
