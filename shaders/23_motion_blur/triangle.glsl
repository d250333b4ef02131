// A ray against a triangle, without a gap between two that share an edge (Woop, Benthin and Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2:1, 2013).

struct Crossing {
    float t;
    vec2 barycentrics;    // of the second and third corner
};

// Axes in another order, that of the direction's largest coordinate last.
vec3 ordered(vec3 v, vec3 size) {
    return size.x > size.y && size.x > size.z ? v.yzx : size.y > size.z ? v.zxy : v;
}

// Intersects a line with a triangle. Seen along the ray, an edge has the origin on one side; the
// triangle on the other side of the edge computes the same number with the other sign, to the bit.
bool crosses(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c, out Crossing crossing) {
    vec3 size = abs(direction);
    vec3 d = ordered(direction, size);
    precise vec2 shear = d.xy / d.z;
    precise vec3 pa = ordered(a - origin, size);
    precise vec3 pb = ordered(b - origin, size);
    precise vec3 pc = ordered(c - origin, size);
    precise vec2 fa = pa.xy - shear * pa.z;
    precise vec2 fb = pb.xy - shear * pb.z;
    precise vec2 fc = pc.xy - shear * pc.z;
    precise float u = fc.x * fb.y - fc.y * fb.x;
    precise float v = fa.x * fc.y - fa.y * fc.x;
    precise float w = fb.x * fa.y - fb.y * fa.x;
    bool outside = min(min(u, v), w) < 0.0 && max(max(u, v), w) > 0.0;
    precise float sum = u + v + w;
    if (outside || sum == 0.0) {
        return false;
    }
    crossing.barycentrics = vec2(v, w) / sum;
    crossing.t = (u * pa.z + v * pb.z + w * pc.z) / (sum * d.z);
    return true;
}
