// The distance of a pixel from the edges of the triangle that its ray hit.

// The distances in pixels to the three edges, each opposite its corner; inside the triangle all are
// positive. Everything is in object space: the corners, the eye, the basis of the picture.
//
// The eye and an edge span a plane with the normal n. A direction lies in it if f = n·direction is 0, and a
// pixel's direction, forward + x·right + y·up, is linear in x and y. So f is linear over the picture: a pixel
// is f / |grad f| away from the line f = 0. No corner is projected, so corners behind the eye do no harm.
vec3 edge_distances(vec3 corners[3], vec3 eye, vec3 direction, vec3 right, vec3 up) {
    vec3 a = corners[0] - eye;
    vec3 b = corners[1] - eye;
    vec3 c = corners[2] - eye;
    // b × c = b × (c - b), and the edge c - b has all its digits where b and c are far and nearly the same.
    vec3 normals[3] = vec3[](
        cross(b, corners[2] - corners[1]), cross(c, corners[0] - corners[2]), cross(a, corners[1] - corners[0]));
    // Towards the triangle's other side from each edge, whichever way its corners turn.
    float side = dot(a, normals[0]) < 0.0 ? -1.0 : 1.0;
    vec3 distances;
    for (uint k = 0; k < 3; k++) {
        // Any length will do: this one keeps the squares below in range, whatever the scene's unit.
        vec3 size = abs(normals[k]);
        vec3 n = normals[k] / max(max(size.x, max(size.y, size.z)), 1e-37);
        vec2 gradient = vec2(dot(n, right), dot(n, up));
        distances[k] = side * dot(n, direction) / max(length(gradient), 1e-30);
    }
    return distances;
}

// The fraction of the pixel that the triangle's lines cover, for closest hit and any-hit shaders. Half of a
// line belongs to the triangle on this side of the edge.
float line_coverage(vec2 barycentrics) {
    vec3 w = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    if (CONSTANT == CONSTANT_WEIGHT) {
        // A hundredth of the triangle for each pixel of the width: this ignores the pixel's real size.
        return min(w.x, min(w.y, w.z)) < 0.01 * push.width ? 1.0 : 0.0;
    }
    mat3 to_object = mat3(gl_WorldToObjectEXT);
    // The length at which the direction reaches the picture's plane, at distance 1.
    vec3 direction = gl_ObjectRayDirectionEXT / dot(gl_WorldRayDirectionEXT, push.camera.forward);
    vec3 right = to_object * push.camera.right * 2.0 / push.size.x;
    vec3 up = to_object * push.camera.up * 2.0 / push.size.y;
    vec3 distances = edge_distances(
        gl_HitTriangleVertexPositionsEXT, gl_ObjectRayOriginEXT, direction, right, up);
    float nearest = min(distances.x, min(distances.y, distances.z));
    // The overlap of the line and the pixel, which is 1 wide.
    float half_width = 0.5 * push.width;
    return clamp(min(nearest + 0.5, half_width) - max(nearest - 0.5, -half_width), 0.0, 1.0);
}
