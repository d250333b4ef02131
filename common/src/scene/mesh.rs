//! A mesh: vertices, triangles that index them, one material.

use anyhow::{Result, bail};
use glam::{DVec3, Vec2, Vec3};

common::shader_struct! {
    /// One vertex, 32 bytes, read by shaders under the same name.
    #[derive(PartialEq)]
    pub struct Vertex {
        /// Position in the mesh's space, in the model's own unit of length.
        pub position: Vec3,
        /// Shading normal, of unit length.
        pub normal: Vec3,
        /// Texture coordinates as Vulkan has them: (0, 0) is the top left corner of the image.
        pub uv: Vec2,
    }
}

/// The largest coordinate: a normal is a product of two edges, so its squared length contains products of four.
pub const REACH: f32 = 1e9;

/// The smallest extent of a model: intersection tests multiply two lengths.
pub const LEAST: f32 = 1e-18;

/// Triangles of one material.
///
/// ```
/// use raybook::prelude::*;
///
/// let corner = |x, z| Vertex { position: Vec3::new(x, 0.0, z), normal: Vec3::Y, uv: Vec2::ZERO };
/// let mesh = Mesh {
///     name: "triangle".to_owned(),
///     vertices: vec![corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 0.0)],
///     triangles: vec![[0, 1, 2]],
///     material: 0,
/// };
/// assert_eq!(mesh.bounds(), (Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The object's name in the model file.
    pub name: String,
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// Three positions in `vertices` each; counter-clockwise as seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// The material, by position in the model.
    pub material: usize,
}

impl Mesh {
    /// Lowest and highest corner of the box around all vertices, used by a triangle or not.
    ///
    /// Without vertices, the box is inverted: +∞ and -∞.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        around(self.vertices.iter().map(|vertex| vertex.position))
    }

    /// Checks that every triangle indexes a vertex, and every position is finite. Returns warnings about likely
    /// mistakes.
    ///
    /// # Errors
    /// Names the mesh, and the first triangle or vertex that is wrong.
    pub fn check(&self) -> Result<Vec<String>> {
        let Self { name, vertices, triangles, .. } = self;
        for (number, triangle) in triangles.iter().enumerate() {
            let beyond = triangle.iter().find(|index| **index as usize >= vertices.len());
            if let Some(index) = beyond {
                bail!(
                    "mesh '{name}': triangle {number} has the vertex {index}, and there are {}, counted from 0",
                    vertices.len()
                );
            }
        }
        let wild = vertices.iter().position(|vertex| !vertex.position.is_finite());
        if let Some(number) = wild {
            bail!("mesh '{name}': vertex {number} is not finite: {}", vertices[number].position);
        }
        let mut warnings = Vec::new();
        if triangles.is_empty() {
            warnings.push(format!("mesh '{name}' has no triangles: there is nothing to see of it"));
        }
        let is_blind = |v: &Vertex| !v.normal.is_finite() || v.normal == Vec3::ZERO;
        if let Some(number) = vertices.iter().position(is_blind) {
            let normal = vertices[number].normal;
            warnings.push(format!(
                "mesh '{name}': the normal of vertex {number} has no direction: {normal}"
            ));
        }
        Ok(warnings)
    }

    /// The largest absolute coordinate.
    pub fn reach(&self) -> f32 {
        let (low, high) = self.bounds();
        low.abs().max(high.abs()).max_element()
    }

    /// True if any triangle has an area. Otherwise no ray hits the mesh.
    ///
    /// # Panics
    /// If a triangle indexes beyond `vertices`.
    pub fn has_area(&self) -> bool {
        self.triangles.iter().any(|corners| {
            let [a, b, c] = corners.map(|i| self.vertices[i as usize].position.as_dvec3());
            (b - a).cross(c - a) != DVec3::ZERO
        })
    }

    /// The box around each triangle, low and high corner, in the order of `triangles`.
    ///
    /// # Panics
    /// If a triangle indexes beyond `vertices`.
    pub fn triangle_bounds(&self) -> Vec<(Vec3, Vec3)> {
        let position = |index: u32| self.vertices[index as usize].position;
        self.triangles.iter().map(|corners| around(corners.iter().map(|&i| position(i)))).collect()
    }
}

/// Lowest and highest corner of the box around points.
pub(crate) fn around(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| {
        (low.min(point), high.max(point))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(positions: &[Vec3], triangles: &[[u32; 3]]) -> Mesh {
        let vertex = |&position| Vertex { position, normal: Vec3::Y, uv: Vec2::ZERO };
        Mesh {
            name: "test".into(),
            vertices: positions.iter().map(vertex).collect(),
            triangles: triangles.to_vec(),
            material: 0,
        }
    }

    #[test]
    fn a_vertex_is_32_bytes_without_gaps() {
        assert_eq!(size_of::<Vertex>(), 32);
        let fields = <Vertex as crate::gpu::ShaderStruct>::LAYOUT.fields.iter();
        let offsets: Vec<_> = fields.map(|(name, at, _)| (*name, *at)).collect();
        assert_eq!(offsets, [("position", 0), ("normal", 12), ("uv", 24)]);
    }

    #[test]
    fn bounds_enclose_every_vertex() {
        let points = [Vec3::new(1.0, -2.0, 3.0), Vec3::new(-4.0, 5.0, 0.5), Vec3::ZERO];
        let bounds = (Vec3::new(-4.0, -2.0, 0.0), Vec3::new(1.0, 5.0, 3.0));
        assert_eq!(mesh(&points, &[]).bounds(), bounds);
        assert_eq!(mesh(&[], &[]).bounds(), (Vec3::INFINITY, Vec3::NEG_INFINITY));
    }

    #[test]
    fn one_triangle_with_an_area_is_enough() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::Y, 3.0 * Vec3::X];
        assert!(!mesh(&points, &[]).has_area());
        assert!(!mesh(&points, &[[0, 1, 1], [0, 1, 3]]).has_area());
        assert!(mesh(&points, &[[0, 1, 1], [0, 1, 2]]).has_area());
        // Products of such edges vanish in 32 bits.
        assert!(mesh(&points.map(|point| point * 1e-30), &[[0, 1, 2]]).has_area());
    }

    #[test]
    fn each_triangle_has_its_box_in_order() {
        let points = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 2.0, -6.0), Vec3::ONE];
        let boxes = mesh(&points, &[[0, 1, 2], [3, 3, 0]]).triangle_bounds();
        assert_eq!(boxes[0], (Vec3::new(0.0, 0.0, -6.0), Vec3::new(4.0, 2.0, 0.0)));
        assert_eq!(boxes[1], (Vec3::ZERO, Vec3::ONE));
    }
}
