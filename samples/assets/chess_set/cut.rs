//! Cuts through meshes along planes: the slot in the bishop's mitre, the foot of the knight's neck.
//!
//! Triangles are split where they cross a plane; those on the wrong side are dropped.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::mesh::{Mesh, QUANTUM, Vertex, quantized};

/// Corners nearer to a plane than this count as on it, which avoids slivers.
const ON_PLANE: f64 = 1.5e-3;

/// The plane `normal · p = offset`; inside is where the difference is negative.
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    fn off(&self, point: DVec3) -> f64 {
        (self.normal.dot(point) - self.offset).abs()
    }

    /// Negative inside, 0 on the plane or so near to it that it counts as on it.
    fn distance(&self, vertex: &Vertex) -> f64 {
        let distance = self.normal.dot(vertex.position) - self.offset;
        if distance.abs() < ON_PLANE { 0.0 } else { distance }
    }
}

/// The part of the mesh above y = `height`, and the points around the opening.
pub fn above(mesh: Mesh, height: f64) -> (Mesh, Vec<DVec3>) {
    let plane = Plane { normal: DVec3::Y, offset: height };
    let (mut below, mut above) = (Vec::new(), Vec::new());
    for triangle in &mesh.triangles {
        split(&plane, triangle, &mut below, &mut above);
    }
    let opening: BTreeMap<_, _> =
        rim(&above).into_iter().flatten().map(|point| (quantized(point), point)).collect();
    (Mesh { triangles: above }, opening.into_values().collect())
}

/// Takes a slot between two parallel planes out of a convex part of a mesh: each wall of the slot
/// is then a convex polygon, for which a fan will do. Saws from outside against the direction
/// `outward` down to the point `bottom`. The blade is `width` thick and its faces are
/// perpendicular to `across`, which is perpendicular to `outward`; both are unit vectors.
pub fn saw(mesh: Mesh, bottom: DVec3, outward: DVec3, across: DVec3, width: f64) -> Mesh {
    // The bottom comes first: only what is above it is split by the other two.
    let planes = [
        Plane { normal: -outward, offset: -outward.dot(bottom) },
        Plane { normal: across, offset: across.dot(bottom) + width / 2.0 },
        Plane { normal: -across, offset: -across.dot(bottom) + width / 2.0 },
    ];
    let mut result = Mesh::default();
    let mut rest = mesh.triangles;
    for plane in &planes {
        let mut inside = Vec::new();
        for triangle in rest {
            split(plane, &triangle, &mut inside, &mut result.triangles);
        }
        rest = inside;
    }
    // `rest` is now what the blade takes away. The rim of the hole are the edges with a triangle
    // on one side only; those that lie in a plane are the rim of its wall.
    let mut walls = planes.each_ref().map(|_| BTreeMap::new());
    for edge in rim(&rest) {
        let off = planes.each_ref().map(|plane| edge.map(|end| plane.off(end)).iter().sum::<f64>());
        let nearest =
            if off[0] < off[1].min(off[2]) { 0 } else { 1 + usize::from(off[2] < off[1]) };
        walls[nearest].extend(edge.map(|end| (quantized(end), end)));
    }
    for &corner in walls[0].values() {
        split_at(&mut result, corner);
    }
    for (plane, wall) in planes.iter().zip(walls) {
        let mut corners: Vec<_> = wall.into_values().collect();
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        // The wall faces the hole.
        let normal = -plane.normal;
        let (right, up) = normal.any_orthonormal_pair();
        let angle = |p: &DVec3| (p - centre).dot(up).atan2((p - centre).dot(right));
        corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        result.flat(&corners, normal);
    }
    result
}

/// Cuts a triangle along a plane and adds the parts to the two lists.
fn split(
    plane: &Plane,
    triangle: &[Vertex; 3],
    inside: &mut Vec<[Vertex; 3]>,
    outside: &mut Vec<[Vertex; 3]>,
) {
    let side = triangle.map(|vertex| plane.distance(&vertex));
    let (mut below, mut above) = (Mesh::default(), Mesh::default());
    let (mut low, mut high) = (Vec::new(), Vec::new());
    for i in 0..3 {
        let j = (i + 1) % 3;
        if side[i] <= 0.0 {
            low.push(triangle[i]);
        }
        if side[i] >= 0.0 {
            high.push(triangle[i]);
        }
        if side[i] * side[j] < 0.0 {
            // The neighbour runs along this edge the other way; both must get the same point.
            let (a, b) = if side[i] < 0.0 { (i, j) } else { (j, i) };
            let point = triangle[a].lerp(&triangle[b], side[a] / (side[a] - side[b]));
            low.push(point);
            high.push(point);
        }
    }
    // A triangle that only touches the plane leaves one or two points on the other side.
    if low.len() > 2 && side.iter().any(|&s| s < 0.0) {
        below.polygon(&low);
    }
    if high.len() > 2 && (below.triangles.is_empty() || side.iter().any(|&s| s > 0.0)) {
        above.polygon(&high);
    }
    inside.extend(below.triangles);
    outside.extend(above.triangles);
}

/// Splits the triangle that has `point` inside one of its edges, if there is one. Where the first
/// plane cut an edge in, only the triangle above it was split again by the others.
fn split_at(mesh: &mut Mesh, point: DVec3) {
    for index in 0..mesh.triangles.len() {
        let triangle = mesh.triangles[index];
        for i in 0..3 {
            let (a, b, c) = (triangle[i], triangle[(i + 1) % 3], triangle[(i + 2) % 3]);
            let [to_a, to_b] = [a, b].map(|end| end.position.distance(point));
            let length = a.position.distance(b.position);
            if to_a.min(to_b) > QUANTUM && to_a + to_b - length < 1e-9 {
                let middle = a.lerp(&b, to_a / length);
                mesh.triangles[index] = [a, middle, c];
                mesh.triangle(middle, b, c);
                break;
            }
        }
    }
}

/// The edges that belong to one triangle only.
fn rim(triangles: &[[Vertex; 3]]) -> Vec<[DVec3; 2]> {
    let mut edges = BTreeMap::<_, (u32, [DVec3; 2])>::new();
    for triangle in triangles {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = (triangle[i].position, triangle[j].position);
            let (from, to) = (quantized(a), quantized(b));
            edges.entry((from.min(to), from.max(to))).or_insert((0, [a, b])).0 += 1;
        }
    }
    edges.into_values().filter(|(uses, _)| *uses == 1).map(|(_, ends)| ends).collect()
}
