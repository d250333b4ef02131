//! Surface nets: a mesh of the zero surface of a function of space, negative inside.
//!
//! Gibson's method (1998): each cell of a grid that the surface passes gets one vertex, and each
//! edge of the grid that it passes gets a quad between the four cells around that edge. The
//! vertices are then spread out evenly and put onto the surface; normals are the function's
//! gradient, which shows more than the mesh has room for.

use glam::{DVec3, IVec3, dvec2};

use crate::mesh::{Mesh, Vertex};

/// Rounds of spreading out the vertices.
const RELAXATIONS: u32 = 4;

/// The box of the grid and the side of its cells. The surface must not leave the box.
pub struct Grid {
    /// The corner with the smallest coordinates.
    pub low: DVec3,
    /// The opposite corner, up to the size of a cell.
    pub high: DVec3,
    /// The side of a cell.
    pub cell: f64,
}

/// The mesh of the surface where `f` is zero. Texture coordinates are x and y.
pub fn surface(grid: &Grid, f: impl Fn(DVec3) -> f64) -> Mesh {
    let size = ((grid.high - grid.low) / grid.cell).ceil().as_ivec3() + 1;
    let index = |p: IVec3| ((p.z * size.y + p.y) * size.x + p.x) as usize;
    let corner = |p: IVec3| grid.low + p.as_dvec3() * grid.cell;
    let points: Vec<_> = (0..size.z)
        .flat_map(|z| (0..size.y).map(move |y| (y, z)))
        .flat_map(|(y, z)| (0..size.x).map(move |x| IVec3::new(x, y, z)))
        .collect();
    let values: Vec<_> = points.iter().map(|&p| f(corner(p))).collect();

    // The edges of the grid that pass the surface, and the quads around them.
    let mut cells = vec![None; points.len()];
    let mut vertices: Vec<(DVec3, f64)> = Vec::new();
    let mut quads = Vec::new();
    for &p in &points {
        for axis in 0..3 {
            let mut q = p;
            q[axis] += 1;
            if q[axis] >= size[axis] || (values[index(p)] < 0.0) == (values[index(q)] < 0.0) {
                continue;
            }
            let (a, b) = (values[index(p)], values[index(q)]);
            let crossing = corner(p).lerp(corner(q), a / (a - b));
            // The cells around the edge, counter-clockwise as seen from its far end.
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut quad = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(du, dv)| {
                let mut cell = p;
                cell[u] -= du;
                cell[v] -= dv;
                let vertex = *cells[index(cell)].get_or_insert_with(|| {
                    vertices.push((DVec3::ZERO, 0.0));
                    vertices.len() - 1
                });
                vertices[vertex].0 += crossing;
                vertices[vertex].1 += 1.0;
                vertex
            });
            if a >= 0.0 {
                quad.reverse();
            }
            quads.push(quad);
        }
    }
    let mut vertices: Vec<_> = vertices.iter().map(|(sum, count)| sum / count).collect();
    relax(&mut vertices, &quads, grid.cell, &f);

    let corners: Vec<_> = vertices
        .iter()
        .map(|&position| Vertex {
            position,
            normal: gradient(&f, position, 0.25 * grid.cell).normalize(),
            uv: dvec2(position.x, position.y),
        })
        .collect();
    let mut mesh = Mesh::default();
    for quad in &quads {
        let [a, b, c, d] = quad.map(|i| corners[i]);
        // Split along the diagonal whose ends bend less away from each other.
        if a.normal.dot(c.normal) > b.normal.dot(d.normal) {
            mesh.polygon(&[a, b, c, d]);
        } else {
            mesh.polygon(&[b, c, d, a]);
        }
    }
    mesh
}

/// Moves each vertex to the middle of its neighbours and from there onto the surface, again and
/// again.
fn relax(vertices: &mut [DVec3], quads: &[[usize; 4]], cell: f64, f: &impl Fn(DVec3) -> f64) {
    for round in 0..=RELAXATIONS {
        let mut sums = vec![(DVec3::ZERO, 0.0); vertices.len()];
        for quad in quads {
            for i in 0..4 {
                let sum = &mut sums[quad[i]];
                sum.0 += vertices[quad[(i + 1) % 4]];
                sum.1 += 1.0;
            }
        }
        for (vertex, (sum, count)) in vertices.iter_mut().zip(sums) {
            if round < RELAXATIONS {
                *vertex = vertex.lerp(sum / count, 0.5);
            }
            for _ in 0..3 {
                // Newton's step, kept short where the function is far from a distance.
                let slope = gradient(f, *vertex, 0.05 * cell);
                let step = slope * (f(*vertex) / slope.length_squared());
                *vertex -= step.clamp_length_max(0.3 * cell);
            }
        }
    }
}

/// The gradient of `f` by differences between points `reach` away on both sides. What is much
/// smaller than that does not show in it.
fn gradient(f: &impl Fn(DVec3) -> f64, p: DVec3, reach: f64) -> DVec3 {
    let along = |axis: DVec3| (f(p + axis * reach) - f(p - axis * reach)) / (2.0 * reach);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}
