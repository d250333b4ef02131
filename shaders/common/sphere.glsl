// Taught by 42_distant_spheres.
//
// A ray against a sphere, in four ways that are equal on paper.
//
// f is the ray's origin as seen from the centre, d its direction of any length, r the radius. The roots
// of |f + t·d|² = r², the nearer first, go to `t`; the answer is whether there are any.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

const uint SPHERE_TEXTBOOK = 0;
const uint SPHERE_PROJECTION = 1;
const uint SPHERE_STABLE = 2;
const uint SPHERE_HOST_C = 3;
const uint SPHERE_OFFERED = 4;

// a·t² + 2b·t + c = 0, as it stands in the textbook. The discriminant is the difference of two numbers
// that both grow with the square of the distance: what is left of it far away is rounding.
bool sphere_textbook(vec3 f, vec3 d, float r, out vec2 t) {
    precise float a = dot(d, d);
    precise float b = dot(f, d);
    precise float c = dot(f, f) - r * r;
    precise float discriminant = b * b - a * c;
    t = vec2(0.0);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    precise float root = sqrt(discriminant);
    precise vec2 both = vec2((-b - root) / a, (-b + root) / a);
    t = both;
    return true;
}

// To the foot of the perpendicular from the centre, and half a chord to either side (as in Embree).
// No term is larger than the distance between centre and ray, which is at most r for a hit.
bool sphere_projection(vec3 f, vec3 d, float r, out vec2 t) {
    precise float a = dot(d, d);
    precise float middle = -dot(f, d) / a;
    precise vec3 foot = f + middle * d;
    precise float square = r * r - dot(foot, foot);
    t = vec2(0.0);
    if (!(square >= 0.0)) {
        return false;
    }
    precise float half_chord = sqrt(square / a);
    precise vec2 both = vec2(middle - half_chord, middle + half_chord);
    t = both;
    return true;
}

// The discriminant from the foot of the perpendicular; then the root whose terms have the same sign,
// and the other one from the product of the roots, c / a: no subtraction cancels but that in c.
// (Haines, Guenther and Akenine-Moeller, Ray Tracing Gems, chapter 7.)
bool sphere_stable(vec3 f, vec3 d, float r, out vec2 t) {
    precise float a = dot(d, d);
    precise float b = -dot(f, d);
    precise vec3 foot = f + (b / a) * d;
    precise float discriminant = a * (r * r - dot(foot, foot));
    t = vec2(0.0);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    precise float c = dot(f, f) - r * r;
    precise float q = b < 0.0 ? b - sqrt(discriminant) : b + sqrt(discriminant);
    // q = 0 is a tangent that begins where it touches; both roots are 0.
    if (q != 0.0) {
        precise vec2 both = vec2(c / q, q / a);
        t = b < 0.0 ? both.yx : both;
    }
    return true;
}

// All rays of a camera begin at one point, so c = |f|² - r² is one number a sphere. The host computes
// it in 64 bits, and makes there the subtraction that would cancel here.
bool sphere_host_c(vec3 f, vec3 d, float c, out vec2 t) {
    precise float a = dot(d, d);
    precise float b = -dot(f, d);
    precise float discriminant = b * b - a * c;
    t = vec2(0.0);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    precise float q = b < 0.0 ? b - sqrt(discriminant) : b + sqrt(discriminant);
    if (q != 0.0) {
        precise vec2 both = vec2(c / q, q / a);
        t = b < 0.0 ? both.yx : both;
    }
    return true;
}

// Not a sphere: a hit wherever the ray passes the centre, so that it shows which spheres the device
// offers to the shader at all.
bool sphere_offered(vec3 f, vec3 d, out vec2 t) {
    t = vec2(-dot(f, d) / dot(d, d));
    return true;
}
