//! A closed mesh whose edges and corners are aimed at.

use anyhow::Result;
use glam::DVec3;
use reference::random::Random;
use reference::transform::Transform;
use reference::triangle::Triangle;

use super::world::{Corners, Rows};
use crate::geometry::mesh;

/// Number of times each triangle of an octahedron is cut into four: 512 triangles.
const CUTS: u32 = 3;
/// Coordinates in whole steps of this, so that differences and matrices' products are exact.
const GRID: f64 = 1.0 / 1024.0;
/// The target of the rays.
#[derive(Clone, Copy, PartialEq)]
pub enum Seam {
    Edges,
    Corners,
}

/// A closed convex mesh around the origin.
pub struct Mesh {
    corners: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
    /// The triangles around each corner.
    around: Vec<Vec<usize>>,
}

impl Mesh {
    pub fn new() -> Self {
        let (corners, triangles) = mesh(CUTS);
        let grid = |x: f32| (f64::from(x) / GRID).round() * GRID;
        let corners: Vec<DVec3> =
            corners.iter().map(|v| DVec3::from_array(v.to_array().map(grid))).collect();
        let triangles: Vec<[usize; 3]> =
            triangles.iter().map(|triangle| triangle.map(|v| v as usize)).collect();
        let mut around = vec![Vec::new(); corners.len()];
        for (number, triangle) in triangles.iter().enumerate() {
            triangle.iter().for_each(|&v| around[v].push(number));
        }
        Self { corners, triangles, around }
    }

    /// As a build gets it.
    pub fn built(&self) -> Vec<Corners> {
        let corner = |v: usize| self.corners[v].as_vec3();
        self.triangles.iter().map(|triangle| triangle.map(corner)).collect()
    }

    /// In its place. Rows are such that this is exact.
    pub fn placed(&self, rows: &Rows) -> Result<Vec<Triangle>> {
        let transform = Transform::from_rows(*rows)?;
        let corner = |v: usize| transform.point(self.corners[v]);
        Ok(self.triangles.iter().map(|triangle| triangle.map(corner)).collect())
    }

    /// The position of a seam in the mesh's space, and its triangles.
    pub fn seam(&self, random: &mut Random, seam: Seam) -> (DVec3, Vec<usize>) {
        match seam {
            Seam::Corners => {
                let v = random.below(self.corners.len());
                (self.corners[v], self.around[v].clone())
            }
            Seam::Edges => {
                let triangle = self.triangles[random.below(self.triangles.len())];
                let k = random.below(3);
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                let both = self.around[a].iter().filter(|number| self.around[b].contains(number));
                // In eighths: a whole number of finer steps of the grid.
                let part = (1 + random.below(7)) as f64 / 8.0;
                let at = self.corners[a] + (self.corners[b] - self.corners[a]) * part;
                (at, both.copied().collect())
            }
        }
    }

    /// A fan's triangles, and of each the edges that it does not share with the others, by the corner across.
    pub fn outline(&self, seam: Seam, fan: &[usize]) -> Vec<&'static [usize]> {
        let shared: Vec<usize> = (0..self.corners.len())
            .filter(|v| fan.iter().all(|&number| self.triangles[number].contains(v)))
            .collect();
        let outer = |number: &usize| -> &'static [usize] {
            let at = |k: usize| shared.contains(&self.triangles[*number][k]);
            match (seam, at(0), at(1), at(2)) {
                (Seam::Corners, true, ..) => &[0],
                (Seam::Corners, _, true, _) => &[1],
                (Seam::Corners, ..) => &[2],
                (Seam::Edges, false, ..) => &[1, 2],
                (Seam::Edges, _, false, _) => &[0, 2],
                (Seam::Edges, ..) => &[0, 1],
            }
        };
        fan.iter().map(outer).collect()
    }
}

/// In whole steps, as a ray's origin that aims exactly.
pub fn on_grid(v: DVec3) -> DVec3 {
    (v / GRID).round() * GRID
}

/// The cosine between a ray that comes and the normal that points out of the mesh.
pub fn facing([a, b, c]: &Triangle, direction: DVec3, out: DVec3) -> f64 {
    let normal = (b - a).cross(c - a).normalize();
    let outward = if normal.dot(out) < 0.0 { -normal } else { normal };
    -outward.dot(direction.normalize())
}
