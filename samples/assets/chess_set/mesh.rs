//! Triangle meshes as the generator builds them, and the checks that every mesh must pass.
//!
//! A mesh here is a plain list of triangles whose corners carry all their attributes. Sharing is
//! left to the OBJ writer, which gives equal positions, normals and texture coordinates one number
//! each. So a shape may be put together from parts that know nothing of each other, and a crease
//! is just two corners with one position and two normals.

use std::collections::BTreeMap;

use anyhow::{Result, ensure};
use glam::{DVec2, DVec3};

/// Positions are written in multiples of this; two that round to the same multiple are one.
///
/// All shapes are computed in `f64` and rounded at the end, so that the mathematical functions of
/// another platform, which may differ in the last bit, still lead to the same file.
pub const QUANTUM: f64 = 1e-5;

/// One corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// In squares of the board; y points up.
    pub position: DVec3,
    /// A unit vector, pointing out of the solid.
    pub normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
}

impl Vertex {
    /// The vertex at `t` between `self` (0) and `other` (1).
    pub fn lerp(&self, other: &Self, t: f64) -> Self {
        Self {
            position: self.position.lerp(other.position, t),
            normal: self.normal.lerp(other.normal, t).normalize(),
            uv: self.uv.lerp(other.uv, t),
        }
    }
}

/// Triangles, counter-clockwise as seen from outside.
#[derive(Default)]
pub struct Mesh {
    /// Three corners each.
    pub triangles: Vec<[Vertex; 3]>,
}

impl Mesh {
    /// Adds one triangle.
    pub fn triangle(&mut self, a: Vertex, b: Vertex, c: Vertex) {
        self.triangles.push([a, b, c]);
    }

    /// Adds a convex polygon as a fan around its first corner.
    pub fn polygon(&mut self, corners: &[Vertex]) {
        for pair in corners[1..].windows(2) {
            self.triangle(corners[0], pair[0], pair[1]);
        }
    }

    /// Adds a flat convex polygon with the given normal; texture coordinates are in its plane.
    pub fn flat(&mut self, corners: &[DVec3], normal: DVec3) {
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        let vertex = |&position: &DVec3| Vertex {
            position,
            normal,
            uv: DVec2::new(position.dot(tangent), position.dot(bitangent)),
        };
        self.polygon(&corners.iter().map(vertex).collect::<Vec<_>>());
    }

    /// Adds all triangles of `other`.
    pub fn append(&mut self, other: Mesh) {
        self.triangles.extend(other.triangles);
    }

    /// Fills the gap between two loops around the y axis, each counter-clockwise as seen from
    /// above, with triangles that face up. The loops need not have equally many points.
    pub fn bridge(&mut self, outer: &[DVec3], inner: &[DVec3]) {
        let angle = |p: &DVec3| p.x.atan2(p.z);
        let sorted = |points: &[DVec3]| {
            let mut points = points.to_vec();
            points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            points
        };
        let (outer, inner) = (sorted(outer), sorted(inner));
        // The angle of point `i` of a loop that goes round and round.
        let unrolled = |points: &[DVec3], i: usize| {
            angle(&points[i % points.len()]) + std::f64::consts::TAU * (i / points.len()) as f64
        };
        let (mut i, mut j) = (0, 0);
        while i < outer.len() || j < inner.len() {
            let (a, b) = (outer[i % outer.len()], inner[j % inner.len()]);
            let outer_next = unrolled(&outer, i + 1) <= unrolled(&inner, j + 1);
            let c = if (outer_next && i < outer.len()) || j == inner.len() {
                i += 1;
                outer[i % outer.len()]
            } else {
                j += 1;
                inner[j % inner.len()]
            };
            let normal = (c - a).cross(b - a).normalize();
            self.flat(&[a, c, b], normal);
        }
    }

    /// Fails where a triangle has no area, a normal is not of unit length, or a normal points away
    /// from the side from which the triangle is counter-clockwise.
    pub fn check(&self, name: &str) -> Result<()> {
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| rounded(corner.position));
            let facing = (b - a).cross(c - a);
            ensure!(
                facing.is_finite() && facing.length() > 0.5 * QUANTUM * QUANTUM,
                "{name}: a triangle without area near {a}"
            );
            for corner in corners {
                ensure!(
                    (corner.normal.length() - 1.0).abs() < 1e-6 && corner.uv.is_finite(),
                    "{name}: a bad normal or texture coordinate near {a}"
                );
                // Long thin triangles are turned a little by the rounding; let them be.
                let sliver = facing.length() < 1e-6;
                ensure!(
                    sliver || facing.normalize().dot(corner.normal) > 0.2,
                    "{name}: a normal near {a} disagrees with its triangle"
                );
            }
        }
        Ok(())
    }

    /// Fails unless the triangles enclose a solid: each edge must belong to exactly two of them,
    /// which run along it in opposite directions.
    pub fn check_closed(&self, name: &str) -> Result<()> {
        let mut edges = BTreeMap::<_, (u32, u32)>::new();
        for corners in &self.triangles {
            let keys = corners.map(|corner| quantized(corner.position));
            for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (keys[i], keys[j])) {
                if from < to {
                    edges.entry((from, to)).or_default().0 += 1;
                } else {
                    edges.entry((to, from)).or_default().1 += 1;
                }
            }
        }
        let open: Vec<_> = edges.iter().filter(|(_, uses)| **uses != (1, 1)).collect();
        ensure!(
            open.is_empty(),
            "{name}: {} edges are not shared by two triangles, the first is {:?} (in {QUANTUM})",
            open.len(),
            open[0]
        );
        Ok(())
    }
}

/// The position in multiples of [`QUANTUM`].
pub fn quantized(position: DVec3) -> [i64; 3] {
    (position / QUANTUM).round().to_array().map(|x| x as i64)
}

/// The position as the file will have it.
pub fn rounded(position: DVec3) -> DVec3 {
    (position / QUANTUM).round() * QUANTUM
}
