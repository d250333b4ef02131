//! Convex solids from half-spaces: what they enclose, in f64.

use glam::{DMat3, DVec3, Vec3};

use crate::{Face, Solid};

/// Half the side of a cube that no solid may reach.
const FAR: f64 = 1e6;

/// Adds the faces of a solid to `faces` and returns it with the corners of the box around it.
///
/// # Errors
/// If the half-spaces enclose nothing, or an unbounded body: then a corner is on a distant cube.
pub(super) fn solid(
    center: Vec3,
    planes: &[[f64; 4]],
    material: u32,
    faces: &mut Vec<Face>,
) -> Result<(Solid, (Vec3, Vec3)), &'static str> {
    let mut walls: Vec<(DVec3, f64)> = planes
        .iter()
        .map(|&[x, y, z, distance]| (DVec3::new(x, y, z).normalize(), distance))
        .collect();
    let (first, count) = (faces.len() as u32, walls.len() as u32);
    faces.extend(
        walls.iter().map(|&(normal, distance)| Face {
            normal: normal.as_vec3(),
            distance: distance as f32,
        }),
    );
    walls.extend(
        [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]).map(|n| (n, FAR)),
    );
    let corners = corners(&walls);
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = corners.iter().fold(nothing, |(l, h), c| (l.min(*c), h.max(*c)));
    if corners.is_empty() || (high - low).min_element() < 1e-6 {
        return Err(
            "the planes enclose nothing, or a body thinner than 1e-6; a normal points out of the solid",
        );
    }
    if low.abs().max(high.abs()).max_element() > 0.99 * FAR {
        return Err(
            "the planes enclose no body that ends within 1e6 of its center; add what closes it",
        );
    }
    let solid = Solid { center, first, count, material };
    // A rounding of the faces moves the corners.
    let room = 1e-5 * low.abs().max(high.abs()).max_element();
    let at = |corner: DVec3| (center.as_dvec3() + corner).as_vec3();
    Ok((solid, (at(low - room), at(high + room))))
}

/// The intersections of three walls that no other wall cuts off.
fn corners(walls: &[(DVec3, f64)]) -> Vec<DVec3> {
    let mut corners = Vec::new();
    for (i, a) in walls.iter().enumerate() {
        for (j, b) in walls.iter().enumerate().skip(i + 1) {
            for c in &walls[j + 1..] {
                let matrix = DMat3::from_cols(a.0, b.0, c.0).transpose();
                if matrix.determinant().abs() < 1e-9 {
                    continue;
                }
                let corner = matrix.inverse() * DVec3::new(a.1, b.1, c.1);
                let slack = 1e-9 * corner.length().max(1.0);
                if walls.iter().all(|(normal, distance)| normal.dot(corner) <= distance + slack) {
                    corners.push(corner);
                }
            }
        }
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn octahedron(distance: f64) -> Vec<[f64; 4]> {
        let signs = [-1.0, 1.0];
        let all = signs.map(|x| signs.map(|y| signs.map(|z| [x, y, z, distance])));
        all.into_iter().flatten().flatten().collect()
    }

    #[test]
    fn the_box_of_an_octahedron_reaches_its_corners() {
        let mut faces = vec![];
        let planes = octahedron(1.0 / 3f64.sqrt());
        let (solid, (low, high)) = super::solid(Vec3::Y, &planes, 3, &mut faces).unwrap();
        assert_eq!((solid.first, solid.count, faces.len()), (0, 8, 8));
        assert!((low - Vec3::new(-1.0, 0.0, -1.0)).length() < 1e-4, "{low}");
        assert!((high - Vec3::new(1.0, 2.0, 1.0)).length() < 1e-4, "{high}");
    }

    #[test]
    fn what_is_open_or_empty_is_refused() {
        let mut open = octahedron(1.0);
        open.retain(|plane| plane[1] > 0.0);
        let refused =
            |planes: &[[f64; 4]]| super::solid(Vec3::ZERO, planes, 0, &mut vec![]).unwrap_err();
        assert!(refused(&open).contains("no body that ends"));
        assert!(refused(&octahedron(-1.0)).contains("nothing"));
    }
}
