// Taught by 39_far_from_origin.
//
// A ray's origin as an instance's mesh sees it: two ways through the same matrix.
//
// With M = [L T] the mesh's origin is at T, and o' = L^-1·(o - T) = L^-1·o - L^-1·T. On paper.

// The inverse matrix, which contains -L^-1·T, times [o; 1]. Both parts are as large as o and T, and have been
// rounded before they are subtracted: far from the origin their difference is noise.
vec3 object_origin_matrix(mat4x3 world_to_object, vec3 o) {
    precise vec3 origin = world_to_object * vec4(o, 1.0);
    return origin;
}

// The difference first: near the instance it is exact (Sterbenz 1974), and all later errors are relative
// to it. `inverse` is L^-1, computed by the host in 64 bits and rounded once.
vec3 object_origin_inverse(mat3 inverse, vec3 translation, vec3 o) {
    precise vec3 apart = o - translation;
    precise vec3 origin = inverse * apart;
    return origin;
}
