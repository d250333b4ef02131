//! The board, its frame, and the fretwork screen behind it.

use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::lathe::Profile;
use crate::mesh::{Mesh, Vertex};

/// Half the side of the board.
const HALF: i32 = 4;

/// The squares of one colour: their tops, at y = 0. The frame closes the solid around and below
/// them. As the rules have it, the square at white's right hand, (+x, +z), is light.
pub fn squares(light: bool) -> Mesh {
    let mut mesh = Mesh::default();
    for x in -HALF..HALF {
        for z in (-HALF..HALF).filter(|z| ((x + z) % 2 == 0) == light) {
            // The four corners, counter-clockwise as seen from above.
            let corners = [(x, z + 1), (x + 1, z + 1), (x + 1, z), (x, z)].map(|(x, z)| Vertex {
                position: dvec3(f64::from(x), 0.0, f64::from(z)),
                normal: DVec3::Y,
                uv: dvec2(f64::from(x + HALF), f64::from(HALF - z)),
            });
            mesh.polygon(&corners);
        }
    }
    mesh
}

/// The frame around the squares, with the board's thickness and underside.
pub fn frame() -> Mesh {
    let half = f64::from(HALF);
    // From the underside out, up and in to the squares; the radius is the distance of a side.
    let profile = Profile::new(half, -0.34)
        .line(half + 0.66, -0.34)
        .arc(half + 0.66, -0.22, 0.5)
        .line(half + 0.62, -0.20)
        .line(half + 0.62, -0.17)
        .curve([half + 0.60, -0.10], [half + 0.55, -0.12], [half + 0.55, -0.03])
        .arc(half + 0.50, 0.02, 0.414)
        .line(half + 0.07, 0.02)
        .line(half + 0.05, 0.0)
        .line(half, 0.0);
    let mut mesh = Mesh::default();
    let points: Vec<_> = profile.points().collect();
    for turn in 0..4 {
        let angle = f64::from(turn) * std::f64::consts::FRAC_PI_2;
        let (sin, cos) = (angle.sin().round(), angle.cos().round());
        // A side runs along x at z = distance; the others are that one turned.
        let place = |p: DVec3| dvec3(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin);
        let mut last = points.len() - 1;
        // Along the squares the frame has the same corners as they: otherwise light leaks through the joint.
        let steps: Vec<_> = (-HALF..=HALF).map(f64::from).collect();
        let (outer, inner) = (points[last - 1], points[last]);
        let corner = |x: f64, p: DVec2| place(dvec3(x, p.y, p.x));
        for pair in steps.windows(2) {
            let tip = corner(-outer.x, outer);
            mesh.flat(&[tip, corner(pair[1], inner), corner(pair[0], inner)], DVec3::Y);
        }
        let tips = [corner(-outer.x, outer), corner(outer.x, outer), corner(half, inner)];
        mesh.flat(&tips, DVec3::Y);
        while last > 1 {
            last -= 1;
            let (low, high) = (points[last - 1], points[last]);
            let along = high - low;
            let normal = place(dvec3(0.0, -along.x, along.y).normalize());
            let corners = [
                corner(-low.x, low),
                corner(low.x, low),
                corner(high.x, high),
                corner(-high.x, high),
            ];
            mesh.flat(&corners, normal);
        }
    }
    // The underside.
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let bottom = corners.map(|(x, z)| dvec3(x * half, points[0].y, z * half));
    mesh.flat(&bottom, -DVec3::Y);
    mesh
}

/// The width and height of the screen, in tiles of the fretwork.
const TILES: [i32; 2] = [8, 3];

/// The screen: one sheet of fretwork in the plane z = 0, front to +z. Each tile has all of the
/// picture, so that it makes no difference how a sampler treats coordinates beyond [0, 1].
pub fn screen() -> Mesh {
    let mut mesh = Mesh::default();
    for x in 0..TILES[0] {
        for y in 0..TILES[1] {
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| Vertex {
                position: dvec3(f64::from(x + u - TILES[0] / 2), f64::from(y + v), 0.0),
                normal: DVec3::Z,
                uv: dvec2(f64::from(u), f64::from(v)),
            });
            mesh.polygon(&corners);
        }
    }
    mesh
}

/// The bars that hold the screen: four, mitred at the corners.
pub fn screen_frame() -> Mesh {
    let [x, y] = TILES.map(f64::from);
    let (width, depth) = (0.12, 0.06);
    // The inner and the outer rectangle, counter-clockwise as seen from +z.
    let rectangle = |by: f64| {
        let [left, right, low, high] = [-x / 2.0 - by, x / 2.0 + by, 0.04 - by, y + by];
        [dvec2(left, low), dvec2(right, low), dvec2(right, high), dvec2(left, high)]
    };
    let (inner, outer) = (rectangle(-0.04), rectangle(width - 0.08));
    let mut mesh = Mesh::default();
    for i in 0..4 {
        let j = (i + 1) % 4;
        let (a, b, c, d) = (outer[i], outer[j], inner[j], inner[i]);
        let at = |p: DVec2, side: f64| p.extend(side * depth);
        let out = -(b - a).perp().normalize().extend(0.0);
        mesh.flat(&[at(a, 1.0), at(b, 1.0), at(c, 1.0), at(d, 1.0)], DVec3::Z);
        mesh.flat(&[at(b, -1.0), at(a, -1.0), at(d, -1.0), at(c, -1.0)], -DVec3::Z);
        mesh.flat(&[at(a, -1.0), at(b, -1.0), at(b, 1.0), at(a, 1.0)], out);
        mesh.flat(&[at(d, 1.0), at(c, 1.0), at(c, -1.0), at(d, -1.0)], -out);
    }
    mesh
}
