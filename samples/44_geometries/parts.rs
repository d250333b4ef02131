//! Chess pieces of several parts: each mesh is cut across, and every second part gets another material.

use common::scene::{Instance, Material, Mesh, Scene};
use glam::Vec3;

common::shader_enum! {
    /// The shape of the parts: one above the other, or each of many rings, through each other.
    pub enum Cut { Slices, Rings }
}

/// Rings per part.
const RINGS: f32 = 4.0;

/// The meshes of the chess set that are pieces.
const PIECES: [&str; 6] = ["pawn", "rook", "knight", "bishop", "queen", "king"];

/// The scene with its pieces in `parts` parts, each a mesh and an instance of its own.
pub fn cut(whole: &Scene, cut: Cut, parts: u32) -> Scene {
    let inlay = whole.model.materials.len();
    let mut scene = Scene { instances: Vec::new(), ..whole.clone() };
    let (name, base_color) = ("inlay".to_owned(), Vec3::new(0.3, 0.016, 0.01));
    scene.model.materials.push(Material { name, base_color, ..Material::default() });
    // For each mesh of the whole scene, its parts in the new one.
    let pieces = |mesh: &Mesh| if PIECES.contains(&mesh.name.as_str()) { parts } else { 1 };
    scene.model.meshes = Vec::new();
    let mut parts_of = Vec::new();
    for mesh in &whole.model.meshes {
        let first = scene.model.meshes.len();
        scene.model.meshes.extend(in_parts(mesh, cut, pieces(mesh)));
        parts_of.push(first..scene.model.meshes.len());
    }
    for instance in &whole.instances {
        for (part, mesh) in parts_of[instance.mesh].clone().enumerate() {
            // The foot, and every second part above it but the last.
            let is_inlay = part % 2 == 0 && part + 1 < parts_of[instance.mesh].len();
            let material = if is_inlay { inlay } else { instance.material };
            scene.instances.push(Instance { mesh, material, ..*instance });
        }
    }
    scene
}

/// A mesh in so many parts, those without triangles left out. All parts have all its vertices.
fn in_parts(mesh: &Mesh, cut: Cut, count: u32) -> Vec<Mesh> {
    let (low, high) = mesh.bounds();
    let part = |corners: &[u32; 3]| {
        // Both triangles of a square of the lathe reach from the same height to the same.
        let heights = corners.map(|corner| mesh.vertices[corner as usize].position.y);
        let [min, max] = [
            heights.into_iter().fold(f32::MAX, f32::min),
            heights.into_iter().fold(f32::MIN, f32::max),
        ];
        let height = (0.5 * (min + max) - low.y) / (high.y - low.y);
        match cut {
            Cut::Slices => ((height * count as f32) as u32).min(count - 1),
            Cut::Rings => (height * RINGS * count as f32) as u32 % count,
        }
    };
    let mut parts: Vec<_> = (0..count).map(|_| Vec::new()).collect();
    for corners in &mesh.triangles {
        parts[part(corners) as usize].push(*corners);
    }
    let parts = parts.into_iter().filter(|triangles| !triangles.is_empty());
    parts.map(|triangles| Mesh { triangles, ..mesh.clone() }).collect()
}
