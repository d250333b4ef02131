//! A triangle test in f32 as a GPU computes it, to test the bounds of this crate.

use glam::Vec3;

use super::ray::Ray;
use super::verdict::Answer;

/// A GPU's triangle test, every operation rounded to f32: t, or a miss.
pub type Test = fn(Vec3, Vec3, [Vec3; 3]) -> Option<f32>;

/// 1/x, as wrong as Vulkan lets a division be: by 2.5 ULP, up or down as the bits of x fall; exact
/// for powers of two, as [`Transform`](super::transform::Transform) assumes.
fn reciprocal(x: f32) -> f32 {
    let exact = 1.0 / x;
    if x.to_bits() << 9 == 0 {
        return exact;
    }
    let wrong = if x.to_bits().count_ones().is_multiple_of(2) { 2 } else { -2 };
    f32::from_bits(exact.to_bits().wrapping_add_signed(wrong))
}

/// Woop, Benthin and Wald, by way of a reciprocal.
pub fn woop(o: Vec3, d: Vec3, triangle: [Vec3; 3]) -> Option<f32> {
    let z = d.abs().max_position();
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let reciprocal = reciprocal(d[z]);
    let (sx, sy) = (d[x] * reciprocal, d[y] * reciprocal);
    let relative = triangle.map(|v| v - o);
    let [a, b, c] = relative.map(|v| [v[x] - sx * v[z], v[y] - sy * v[z]]);
    let u = c[0] * b[1] - c[1] * b[0];
    let v = a[0] * c[1] - a[1] * c[0];
    let w = b[0] * a[1] - b[1] * a[0];
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let det = u + v + w;
    let [az, bz, cz] = relative.map(|v| v[z] * reciprocal);
    (det != 0.0).then(|| (u * az + v * bz + w * cz) / det)
}

/// Möller and Trumbore, from both sides.
pub fn moller_trumbore(o: Vec3, d: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return None;
    }
    let reciprocal = reciprocal(det);
    let s = o - a;
    let u = s.dot(p) * reciprocal;
    let q = s.cross(e1);
    let v = d.dot(q) * reciprocal;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| e2.dot(q) * reciprocal)
}

/// The inverse of an instance's matrix by cofactors, every operation rounded to f32.
pub fn invert(m: [[f32; 4]; 3]) -> [[f32; 4]; 3] {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f32 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    let scale = reciprocal(determinant);
    std::array::from_fn(|i| {
        let row: [f32; 3] = std::array::from_fn(|j| cofactor(j, i) * scale);
        [row[0], row[1], row[2], -(row[0] * m[0][3] + row[1] * m[1][3] + row[2] * m[2][3])]
    })
}

/// A vector through such a matrix in f32; `w` is 1 for a point and 0 for a direction.
pub fn apply(m: [[f32; 4]; 3], v: Vec3, w: f32) -> Vec3 {
    Vec3::from(m.map(|row| row[0] * v.x + row[1] * v.y + row[2] * v.z + row[3] * w))
}

const TURNED: [[f32; 4]; 3] =
    [[0.8, -0.6, 0.0, 0.3], [-0.6, -0.8, 0.2, 0.1], [0.1, 0.0, 1.3, -0.4]];
const IDENTITY: [[f32; 4]; 3] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// The rows of an instance's matrix, and its triangles.
pub type Mesh = ([[f32; 4]; 3], Vec<[[f32; 3]; 3]>);

/// Instances of a crumpled sheet; its vertices fall on a lattice, so that rays hit edges.
pub fn meshes() -> Vec<Mesh> {
    let at = |i: i32, j: i32| {
        let height = ((i * 7 + j * 5) % 4) as f32 / 16.0;
        [i as f32 / 4.0, j as f32 / 4.0, height]
    };
    let quads = (-4..4).flat_map(|i| (-4..4).map(move |j| (i, j)));
    let triangles: Vec<_> = quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    vec![(IDENTITY, triangles.clone()), (TURNED, triangles)]
}

/// The nearest hit that a GPU with this triangle test finds.
pub fn render(ray: &Ray, test: Test) -> Option<Answer> {
    let mut closest: Option<Answer> = None;
    for ((rows, triangles), instance) in meshes().into_iter().zip(0..) {
        let inverse = invert(rows);
        let o = apply(inverse, ray.origin.as_vec3(), 1.0);
        let d = apply(inverse, ray.direction.as_vec3(), 0.0);
        for (triangle, primitive) in triangles.into_iter().zip(0..) {
            let t = test(o, d, triangle.map(Vec3::from));
            let farthest = closest.map_or(ray.tmax as f32, |closest| closest.t);
            if let Some(t) = t.filter(|&t| t > ray.tmin as f32 && t < farthest) {
                closest = Some(Answer { instance, primitive, t });
            }
        }
    }
    closest
}
