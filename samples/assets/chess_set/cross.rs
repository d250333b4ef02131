//! The cross on the king's crown: a cross pattée, cut from a plate with chamfered edges.

use glam::{DVec2, DVec3, dvec2};

use crate::mesh::Mesh;

/// Half the thickness of the plate.
const DEPTH: f64 = 0.036;
/// The width of the chamfer.
const CHAMFER: f64 = 0.011;
/// Arms: half their width at the crossing and at the end, and their length from the crossing.
const NARROW: f64 = 0.030;
const WIDE: f64 = 0.066;
const LENGTH: f64 = 0.105;
/// Half the width of the foot.
const FOOT: f64 = 0.044;

/// The cross with its foot at `height`, where it is open, and the loop around that opening,
/// counter-clockwise as seen from above.
pub fn cross(height: f64) -> (Mesh, Vec<DVec3>) {
    let centre = height + LENGTH + 0.015;
    // Counter-clockwise as seen from +z, from the right side of the foot to its left.
    let outline = [
        dvec2(FOOT, height),
        dvec2(NARROW, centre - NARROW),
        dvec2(LENGTH, centre - WIDE),
        dvec2(LENGTH, centre + WIDE),
        dvec2(NARROW, centre + NARROW),
        dvec2(WIDE, centre + LENGTH),
        dvec2(-WIDE, centre + LENGTH),
        dvec2(-NARROW, centre + NARROW),
        dvec2(-LENGTH, centre + WIDE),
        dvec2(-LENGTH, centre - WIDE),
        dvec2(-NARROW, centre - NARROW),
        dvec2(-FOOT, height),
    ];
    let inset: Vec<_> = (0..outline.len()).map(|i| inset(&outline, i)).collect();
    let middle = DVec3::new(0.0, centre, 0.0);

    let mut mesh = Mesh::default();
    for side in [1.0, -1.0] {
        let front = |p: DVec2| p.extend(side * DEPTH);
        let edge = |p: DVec2| p.extend(side * (DEPTH - CHAMFER));
        // Counter-clockwise from the front is clockwise from the back.
        let mut add = |corners: &mut [DVec3]| {
            if side < 0.0 {
                corners.reverse();
            }
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
            mesh.flat(corners, normal);
        };
        for i in 0..outline.len() {
            let j = (i + 1) % outline.len();
            add(&mut [middle + DVec3::Z * side * DEPTH, front(inset[i]), front(inset[j])]);
            // The last edge is the open foot.
            if j != 0 {
                add(&mut [edge(outline[i]), edge(outline[j]), front(inset[j]), front(inset[i])]);
            }
        }
    }
    for pair in outline.windows(2) {
        let [near, far] = [DEPTH - CHAMFER, CHAMFER - DEPTH];
        let corners =
            [pair[0].extend(near), pair[0].extend(far), pair[1].extend(far), pair[1].extend(near)];
        let along = pair[1] - pair[0];
        mesh.flat(&corners, dvec2(along.y, -along.x).normalize().extend(0.0));
    }

    let last = outline.len() - 1;
    let mut foot = Vec::new();
    for side in [1.0, -1.0] {
        foot.extend([outline[0], outline[last]].map(|p| p.extend(side * (DEPTH - CHAMFER))));
        foot.extend([inset[0], inset[last]].map(|p| p.extend(side * DEPTH)));
    }
    (mesh, foot)
}

/// Corner `i` of the outline, moved in by the chamfer; the corners of the foot stay at its height.
fn inset(outline: &[DVec2], i: usize) -> DVec2 {
    let n = outline.len();
    let (before, here, after) = (outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]);
    if i == 0 || i == n - 1 {
        return here - dvec2(CHAMFER * here.x.signum(), 0.0);
    }
    let [a, b] = [here - before, after - here].map(|edge| edge.normalize().perp());
    here + (a + b) * (CHAMFER / (1.0 + a.dot(b)))
}
