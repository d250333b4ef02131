//! Normals of smoothing groups.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::parts::{Geometry, NONE, Part};

/// Gives each corner of a smoothing group that has no normal the mean of the normals of the group's triangles
/// around its place, each weighted by its angle there: how a polygon is cut into triangles must not matter (Thürmer
/// and Wüthrich, J. Graphics Tools 3:1, 1998). Many programs write a position once for each face.
pub(crate) fn smooth(geometry: &mut Geometry) {
    let Geometry { positions, normals, parts, .. } = geometry;
    let triangles = |part: &Part| part.triangles.iter().any(|triangle| triangle.smoothing != 0);
    if !parts.iter().any(triangles) {
        return;
    }
    // The normal of each group and place, first as a sum.
    let mut found: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let mut sums: Vec<DVec3> = Vec::new();
    let first = normals.len();
    for triangle in parts.iter_mut().flat_map(|part| &mut part.triangles) {
        if triangle.smoothing == 0 || triangle.corners.iter().all(|corner| corner.normal != NONE) {
            continue;
        }
        let places = triangle.corners.map(|corner| positions.exact(corner.position));
        for i in 0..3 {
            let corner = &mut triangle.corners[i];
            if corner.normal != NONE {
                continue;
            }
            // Zero has two signs.
            let place = (positions.rounded(corner.position) + Vec3::ZERO).to_array();
            let key = (triangle.smoothing, place.map(f32::to_bits));
            let number = *found.entry(key).or_insert_with(|| {
                sums.push(DVec3::ZERO);
                (first + sums.len() - 1) as u32
            });
            let [here, next, last] = [places[i], places[(i + 1) % 3], places[(i + 2) % 3]];
            let (to_next, to_last) = (next - here, last - here);
            let normal = to_next.cross(to_last);
            let length = normal.length();
            if length > 0.0 {
                let angle = length.atan2(to_next.dot(to_last));
                sums[number as usize - first] += normal / length * angle;
            }
            corner.normal = number;
        }
    }
    // A sum of zero has no direction: such a corner gets its triangle's normal, like every zero.
    normals.extend(sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()));
}
