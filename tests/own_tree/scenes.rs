//! Scenes to build trees for.

use common::glam::Vec3;
use common::scene::{Mesh, Scene};
use own_tree::Bounds;

/// A triangle's corners.
pub type Triangle = [Vec3; 3];

/// A named list of triangles.
pub struct Triangles {
    pub name: String,
    pub list: Vec<Triangle>,
}

impl Triangles {
    /// The bounding box of each.
    pub fn bounds(&self) -> Vec<Bounds> {
        let around = |[a, b, c]: &Triangle| (a.min(*b).min(*c), a.max(*b).max(*c));
        self.list.iter().map(around).collect()
    }
}

/// The triangles of a scene's first mesh.
pub fn triangles(scene: &Scene) -> Vec<Triangle> {
    corners(&scene.model.meshes[0])
}

fn corners(mesh: &Mesh) -> Vec<Triangle> {
    let position = |at: u32| mesh.vertices[at as usize].position;
    mesh.triangles.iter().map(|triangle| triangle.map(position)).collect()
}

/// The meshes of the chess set, and its whole world as one list.
pub fn chess() -> Vec<Triangles> {
    let Scene { model, instances, .. } = Scene::chess().unwrap();
    let world = instances.iter().flat_map(|instance| {
        let placed = move |at| instance.transform.transform_point3(at);
        let list = corners(&model.meshes[instance.mesh]);
        list.into_iter().map(move |triangle| triangle.map(placed))
    });
    let world = Triangles { name: "chess".to_owned(), list: world.collect() };
    let meshes = model.meshes.iter();
    meshes
        .map(|mesh| Triangles { name: mesh.name.clone(), list: corners(mesh) })
        .chain([world])
        .collect()
}

/// Triangles at random places in a cube: for 100,000 a few hundredths of its size, smaller if there are more.
pub fn random_triangles(count: usize) -> Triangles {
    let size = 0.04 * (1e5 / count as f32).cbrt();
    let triangle = |i: u64| {
        let at = point(4 * i);
        [1, 2, 3].map(|corner| at + (point(4 * i + corner) - 0.5) * size)
    };
    let list = (0..count as u64).map(triangle).collect();
    Triangles { name: format!("{count} random triangles"), list }
}

/// The bounding boxes of spheres at random places, of many sizes.
pub fn spheres(count: u64) -> Vec<Bounds> {
    (0..count)
        .map(|i| {
            let radius = 0.002 + 0.02 * chance(9 * i + 5).powi(4);
            (point(3 * i + 7) - radius, point(3 * i + 7) + radius)
        })
        .collect()
}

fn point(i: u64) -> Vec3 {
    Vec3::new(chance(3 * i), chance(3 * i + 1), chance(3 * i + 2))
}

/// A hash of a number (splitmix64), mapped to a number from 0 to 1.
fn chance(i: u64) -> f32 {
    let z = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 40) as f32 / (1 << 24) as f32
}
