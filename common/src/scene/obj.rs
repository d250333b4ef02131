//! Reading an OBJ file: its meshes, and the materials and textures that it names.
//!
//! The text is checked statement by statement and written out again in a plain form, which tobj then
//! parses: only `v`, `vt`, `vn`, `f`, `o` and `usemtl`, every corner with all three indices.

use std::path::Path;

use anyhow::{Result, anyhow, ensure};
use glam::{Vec2, Vec3};

use super::limits::Limits;
use super::material::Material;
use super::mesh::{LEAST, Mesh, REACH, Vertex, around};
use super::obj_check::Check;
use super::text::{Folder, Text, shown};
use super::texture::Texture;

/// All that an OBJ file holds and names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The meshes in the file's order; at least one, none without triangles.
    pub meshes: Vec<Mesh>,
    /// The materials that meshes index.
    pub materials: Vec<Material>,
    /// The textures that materials index.
    pub textures: Vec<Texture>,
    /// What is wrong with the files and what stands for it, a line for each kind, with file and line of
    /// the first and the count of all.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file with its MTL files and PNG textures.
///
/// A new object, a new group in a file without objects, or another material starts a new mesh.
/// Polygons become fans of triangles. A corner without a normal gets its triangle's: a cube must
/// not be shaded like a ball, and OBJ smooths only where a file says so. Texture coordinates are turned to
/// Vulkan's, v downwards; a corner without them gets (0, 0). A face without material gets
/// [`Material::default`]. Lines, points, curved surfaces and vertex colours are passed over.
///
/// Files of the world are often incomplete. An MTL file that is not there, a texture that is not there or
/// outside the OBJ file's folder, a material that is not defined, a normal or texture coordinate out of range, a statement of another format: the model
/// comes without, and with a line in [`Model::warnings`].
///
/// # Errors
/// If the file is missing or has no faces, if a vertex or a number in any of the files is wrong, if it reaches
/// too far or is too small, takes too much memory, or one of the files is too large, or an MTL file outside the OBJ file's
/// folder; the message is one line with file and line number.
pub fn load(path: &Path) -> Result<Model> {
    let model = load_within(path, &Limits::DEFAULT)?;
    let reach = model.meshes.iter().map(Mesh::reach).fold(0.0, f32::max);
    ensure!(
        reach <= REACH,
        "{}: reaches {reach:e} from the origin; beyond {REACH:e}, products of four coordinates overflow in \
         32 bits",
        shown(path)
    );
    let (low, high) = around(model.meshes.iter().flat_map(|mesh| <[Vec3; 2]>::from(mesh.bounds())));
    let size = (high - low).max_element();
    ensure!(
        size == 0.0 || size >= LEAST,
        "{}: is {size:e} from end to end; below {LEAST:e}, products of two lengths vanish in 32 bits",
        shown(path)
    );
    Ok(model)
}

fn load_within(path: &Path, limits: &Limits) -> Result<Model> {
    let folder = Folder::of(path)?;
    let text = Text::read(path, shown(path), limits.obj_bytes)?;
    let Check { plain, library, mut warnings, .. } = Check::run(&text, &folder, limits)?;
    let (mut materials, textures) = library.finish(limits, &mut warnings);

    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    // Only names and positions: what the materials hold was read in the check.
    let names =
        materials.iter().enumerate().map(|(index, material)| (material.name.clone(), index));
    let names = |_: &Path| Ok((Vec::new(), names.clone().collect()));
    let parsed = tobj::load_obj_buf(&mut plain.as_bytes(), &options, names);
    let (models, _) = parsed.map_err(|error| anyhow!("{}: tobj: {error}", text.shown))?;

    let models = models.into_iter().filter(|model| !model.mesh.indices.is_empty());
    let default = materials.len();
    let meshes: Vec<_> = models.map(|model| mesh(model, default)).collect();
    if meshes.iter().any(|mesh| mesh.material == default) {
        materials.push(Material::default());
    }
    Ok(Model { meshes, materials, textures, warnings: warnings.lines() })
}

/// A mesh as shaders want it: normals of unit length, texture coordinates from the top.
fn mesh(model: tobj::Model, default_material: usize) -> Mesh {
    let tobj::Mesh { positions, normals, texcoords, indices, material_id, .. } = model.mesh;
    let position = |index: u32| Vec3::from_slice(&positions[3 * index as usize..]);
    let mut triangles: Vec<[u32; 3]> =
        indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    let mut vertices = Vec::with_capacity(positions.len() / 3);
    // Where a vertex with a normal went; the others stay with their triangle.
    let mut moved = vec![None; positions.len() / 3];
    for triangle in &mut triangles {
        let flat = flat_normal(triangle.map(position));
        for corner in triangle {
            let from = *corner as usize;
            let normal = unit(Vec3::from_slice(&normals[3 * from..]));
            *corner = moved[from].unwrap_or_else(|| {
                let uv = Vec2::new(texcoords[2 * from], 1.0 - texcoords[2 * from + 1]);
                let normal = normal.unwrap_or(flat);
                vertices.push(Vertex { position: position(*corner), normal, uv });
                vertices.len() as u32 - 1
            });
            moved[from] = normal.map(|_| *corner);
        }
    }
    let material = material_id.unwrap_or(default_material);
    Mesh { name: model.name, vertices, triangles, material }
}

/// The normal of a counter-clockwise triangle; any direction if it has no area, as no ray meets it.
fn flat_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    // Products of 32-bit numbers that are large or small enough overflow or vanish in 32 bits.
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    if length > 0.0 { (normal / length).as_vec3() } else { Vec3::Y }
}

/// The vector with unit length, unless it is zero.
fn unit(vector: Vec3) -> Option<Vec3> {
    let vector = vector.as_dvec3();
    let length = vector.length();
    (length > 0.0).then(|| (vector / length).as_vec3())
}

#[cfg(test)]
pub(super) mod tests;
