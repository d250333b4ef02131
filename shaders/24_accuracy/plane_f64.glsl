// A ray against a plane in 64 bits, for devices that have them. After common/plane.glsl.

const uint PLANE_FLOAT64 = 5;

// By the point close by, as in plane_point().
bool plane_float64(Plane plane, vec3 o, vec3 d, float tmin, float tmax, out float t, out vec3 normal) {
    dvec3 n = dvec3(plane.normal);
    precise dvec3 to_plane = dvec3(plane.anchor) - dvec3(o);
    precise double height = dot(to_plane, n) + double(plane.rest);
    precise double slope = dot(dvec3(d), n);
    t = 0.0;
    normal = vec3(0.0);
    if (slope == 0.0) {
        return false;
    }
    precise double quotient = height / slope;
    if (!(quotient > double(tmin) && quotient <= double(tmax))) {
        return false;
    }
    precise dvec3 unit = n / sqrt(dot(n, n));
    t = float(quotient);
    normal = slope > 0.0 ? -vec3(unit) : vec3(unit);
    return true;
}
