//! Bodies whose faces point inwards: glass depends on which side of a face is inside.

use glam::{DVec3, Vec3};

use super::mesh::Mesh;

/// The part of a body's surface that may be missing: seams whose vertices differ by rounding, and small holes.
const MISSING: f64 = 1e-3;

/// The least volume of a body of unit area; a sheet with two sides has none.
const THIN: f64 = 1e-9;

impl Mesh {
    /// True if the triangles enclose a body and have their fronts on its inside.
    ///
    /// # Panics
    /// If a triangle indexes beyond the vertices.
    pub fn is_inside_out(&self) -> bool {
        // Over a closed surface, the areas as vectors add up to zero.
        let (mut sum, mut area, mut volume) = (DVec3::ZERO, 0.0, 0.0);
        // From a vertex, so that a body far from the origin loses no digits.
        let origin = self.vertices.first().map_or(Vec3::ZERO, |vertex| vertex.position).as_dvec3();
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|i| self.vertices[i as usize].position.as_dvec3() - origin);
            let face = (b - a).cross(c - a);
            sum += face;
            area += face.length();
            volume += a.dot(face);
        }
        sum.length() < MISSING * area && volume < -THIN * area.powf(1.5)
    }

    /// Turns the front of every triangle to its other side, and the normals with them if they point where the
    /// fronts did.
    ///
    /// # Panics
    /// If a triangle indexes beyond the vertices.
    pub fn turn_inside_out(&mut self) {
        let along: f64 = self.triangles.iter().map(|corners| self.agreement(corners)).sum();
        if along > 0.0 {
            self.vertices.iter_mut().for_each(|vertex| vertex.normal = -vertex.normal);
        }
        self.triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
    }

    /// The sum of a triangle's three normals along its face normal, weighted by its area.
    fn agreement(&self, corners: &[u32; 3]) -> f64 {
        let corners = corners.map(|i| self.vertices[i as usize]);
        let [a, b, c] = corners.map(|vertex| vertex.position.as_dvec3());
        let face = (b - a).cross(c - a);
        corners.iter().map(|vertex| face.dot(vertex.normal.as_dvec3())).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::obj::tests::load_text;

    const CUBE: &str = "o body\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\n\
        v -1 1 1\nf 5 6 7 8\nf 2 1 4 3\nf 1 5 8 4\nf 6 2 3 7\nf 8 7 3 4\nf 1 2 6 5\n";

    fn mesh(obj: &str) -> Mesh {
        load_text(obj).unwrap().meshes[0].clone()
    }

    fn turned() -> String {
        let line = |line: &str| match line.strip_prefix("f ") {
            Some(corners) => {
                format!("f {}\n", corners.split(' ').rev().collect::<Vec<_>>().join(" "))
            }
            None => format!("{line}\n"),
        };
        CUBE.lines().map(line).collect()
    }

    #[test]
    fn a_body_is_inside_out_if_its_fronts_are_inside() {
        assert!(!mesh(CUBE).is_inside_out());
        assert!(mesh(&turned()).is_inside_out());
        // Far from the origin, and one that is open.
        let far = turned().replace("v -1", "v 9999").replace("v 1", "v 10001");
        assert!(mesh(&far).is_inside_out());
        // A seam whose vertices differ by rounding.
        let seam = turned().replace("f 8 7 6 5", "v 1.0000001 1 1\nf 8 9 6 5");
        assert!(mesh(&seam).is_inside_out());
        assert!(!mesh(&turned().replace("f 5 6 2 1\n", "")).is_inside_out());
        let one = turned().replacen("f 8 7 6 5", "f 5 6 7 8", 1);
        assert!(!mesh(&one).is_inside_out());
        // A sheet with two sides.
        assert!(!mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n").is_inside_out());
    }

    #[test]
    fn a_body_turned_over_is_as_one_that_was_right() {
        let mut body = mesh(&turned());
        body.turn_inside_out();
        assert!(!body.is_inside_out());
        for [a, b, c] in body.triangles.clone() {
            let [a, b, c] = [a, b, c].map(|i| body.vertices[i as usize]);
            let face = (b.position - a.position).cross(c.position - a.position);
            assert!(face.dot(a.normal) > 0.0 && face.dot(a.position) > 0.0);
        }
        // Normals that point outwards stay.
        let mut right = mesh(CUBE);
        right.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        right.turn_inside_out();
        assert_eq!(right, mesh(CUBE));
    }
}
