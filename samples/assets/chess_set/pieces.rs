//! The turned pieces, after the proportions that Nathaniel Cooke registered in 1849 and called
//! Staunton's. Each stands at the origin on y = 0; a square of the board is 1 × 1.
//!
//! The numbers are drawn by eye; each profile reads from the foot up.

use std::f64::consts::TAU;

use glam::{DVec3, dvec2, dvec3};

use crate::lathe::{Profile, on_circle};
use crate::mesh::Mesh;
use crate::{cross, cut};

/// The foot that all pieces share: plinth, cushion and bead, up to `top`, where the stem starts.
/// The bead is narrower than the plinth by the factor `waist`.
pub fn foot(r: f64, waist: f64, top: f64) -> Profile {
    Profile::new(0.0, 0.0)
        .line(r - 0.035, 0.0)
        .arc(r - 0.035, 0.115, 0.6)
        .line(r - 0.05, 0.125)
        .line(r - 0.05, 0.145)
        .curve([r - 0.05, top - 0.13], [(waist + 0.16) * r, top - 0.09], [waist * r, top - 0.06])
        .line(waist * r, top - 0.05)
        .arc(waist * r, top - 0.005, 0.85)
        .line((waist - 0.05) * r, top)
}

/// A collar: a cove out of the stem up to the radius `r`, a round edge, and a slope back in.
fn collar(stem: Profile, r: f64, inner: f64) -> Profile {
    let [start, y] = stem.end().to_array();
    stem.arc(r, y + 0.8 * (r - start), -0.28).arc(r, y + 0.8 * (r - start) + 0.03, 0.8).arc(
        inner,
        y + 0.8 * (r - start) + 0.03 + 0.3 * (r - inner),
        -0.15,
    )
}

/// The pawn: a ball on a collar.
pub fn pawn() -> Mesh {
    let stem = foot(0.33, 0.60, 0.365).curve([0.115, 0.43], [0.105, 0.55], [0.098, 0.675]);
    collar(stem, 0.18, 0.12).ball(0.11, 0.945, 0.185, 0.0).turn(28)
}

/// The rook: a tower with six merlons.
pub fn rook() -> Mesh {
    const SEGMENTS: u32 = 36;
    let (outer, inner, sill, top) = (0.265, 0.185, 1.16, 1.29);
    let body = foot(0.36, 0.60, 0.365)
        .curve([0.165, 0.46], [0.165, 0.66], [0.16, 0.82])
        .arc(0.215, 0.865, -0.28)
        .arc(0.215, 0.895, 0.8)
        .line(0.205, 0.905)
        .curve([0.205, 0.97], [outer, 0.96], [outer, 1.02])
        .line(outer, sill);
    let floor = Profile::new(inner, sill).line(inner, 1.10).arc(0.0, 1.125, 0.05);
    let merlon = Profile::new(outer, sill)
        .line(outer, top - 0.018)
        .arc(outer - 0.018, top, 0.414)
        .line(inner + 0.018, top)
        .arc(inner, top - 0.018, 0.414)
        .line(inner, sill);
    let crenel = Profile::new(outer, sill).line(inner, sill);

    let mut mesh = body.turn(SEGMENTS);
    for start in (0..SEGMENTS).step_by(6) {
        mesh.append(merlon.turn_part(SEGMENTS, start..start + 4));
        mesh.append(crenel.turn_part(SEGMENTS, start + 4..start + 6));
        // The two cheeks of the merlon are its profile, filled.
        for (column, side) in [(start, -1.0), (start + 4, 1.0)] {
            let angle = TAU * f64::from(column) / f64::from(SEGMENTS);
            let mut cheek: Vec<_> = merlon.points().map(|p| on_circle(p, angle)).collect();
            if side > 0.0 {
                cheek.reverse();
            }
            mesh.flat(&cheek, dvec3(angle.cos(), 0.0, -angle.sin()) * side);
        }
    }
    mesh.append(floor.turn(SEGMENTS));
    mesh
}

/// The bishop: a mitre with its slanting cut.
pub fn bishop() -> Mesh {
    let stem = foot(0.36, 0.60, 0.365).curve([0.125, 0.47], [0.115, 0.72], [0.10, 0.955]);
    let collars = collar(collar(stem, 0.195, 0.125), 0.165, 0.11);
    let mesh = collars
        .curve([0.25, 1.22], [0.215, 1.43], [0.052, 1.615])
        .ball(0.04, 1.665, 0.058, 0.0)
        .turn(28);
    let slant = 0.96_f64;
    let outward = dvec3(slant.cos(), slant.sin(), 0.0);
    cut::saw(mesh, dvec3(0.01, 1.335, 0.0), outward, outward.cross(DVec3::Z), 0.048)
}

/// The queen: a scalloped coronet around a dome with a pearl.
pub fn queen() -> Mesh {
    const SEGMENTS: u32 = 40;
    let stem = foot(0.39, 0.60, 0.365).curve([0.135, 0.50], [0.13, 0.88], [0.11, 1.22]);
    let collars = collar(collar(stem, 0.215, 0.145), 0.185, 0.125);
    collars
        .curve([0.135, 1.55], [0.175, 1.63], [0.245, 1.72])
        .ripple(1.0)
        .line(0.262, 1.765)
        .arc(0.243, 1.772, 0.9)
        .ripple(0.0)
        .line(0.20, 1.725)
        .curve([0.19, 1.80], [0.12, 1.84], [0.055, 1.855])
        .ball(0.045, 1.91, 0.068, 0.0)
        .turn_rippled(SEGMENTS, 0..SEGMENTS, |angle| {
            let scallops = 8.0;
            let height = 0.026;
            dvec2((scallops * angle).cos(), -scallops * (scallops * angle).sin()) * height
        })
}

/// The king: a closed crown with a cross.
pub fn king() -> Mesh {
    const SEGMENTS: u32 = 36;
    let stem = foot(0.41, 0.60, 0.365).curve([0.145, 0.51], [0.14, 0.95], [0.12, 1.32]);
    let collars = collar(collar(stem, 0.23, 0.155), 0.20, 0.135);
    let body = collars
        .curve([0.145, 1.68], [0.185, 1.77], [0.245, 1.86])
        .arc(0.245, 1.90, 0.9)
        .line(0.215, 1.905)
        .curve([0.205, 1.965], [0.13, 1.985], [0.07, 2.005])
        .line(0.07, 2.012)
        .arc(0.07, 2.05, 0.8);
    let ring: Vec<_> = (0..SEGMENTS)
        .map(|i| on_circle(body.end(), TAU * f64::from(i) / f64::from(SEGMENTS)))
        .collect();
    let (cross, foot) = cross::cross(body.end().y);
    let mut mesh = body.turn(SEGMENTS);
    mesh.bridge(&ring, &foot);
    mesh.append(cross);
    mesh
}
