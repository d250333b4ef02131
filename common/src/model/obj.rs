//! Reading an OBJ file: its meshes, and the materials and textures it names.
//!
//! Files from outside are untrusted, and often not quite right: [`load`] reads them with line numbers and limits.
//! tobj reads the project's own.

use std::path::Path;

use anyhow::{Context, Result};
use glam::{Vec2, Vec3};

pub use super::load::{load, load_centered};
use super::text::{note_opened, shown};
use super::texture::Texture;
use crate::scene::light::LightSource;
use crate::scene::material::Material;
use crate::scene::mesh::{Mesh, Vertex};

/// The contents of an OBJ file and of the files it names.
///
/// ```
/// use raybook::prelude::*;
///
/// /// A scene of one mesh, made without a file.
/// fn scene(mesh: Mesh) -> Scene {
///     let transform = Affine3A::IDENTITY;
///     let placed = Instance { mesh: 0, transform, material: mesh.material, record_offset: 0 };
///     let materials = vec![Material::default()];
///     let model = Model { meshes: vec![mesh], materials, ..Model::default() };
///     Scene { model, instances: vec![placed], camera: Camera::default() }
/// }
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The meshes in the file's order; at least one, each with triangles. An object of several materials is
    /// several meshes of its name.
    pub meshes: Vec<Mesh>,
    /// The materials of the meshes.
    pub materials: Vec<Material>,
    /// The textures of the materials.
    pub textures: Vec<Texture>,
    /// The lights of the file, in the world.
    pub lights: Vec<LightSource>,
    /// Warnings about the files and the replacements used, one line per kind, with file and line of the first and
    /// the count of all.
    pub warnings: Vec<String>,
    /// Names that several objects of the file have: they do not say which is meant.
    pub ambiguous: Vec<String>,
}

/// Reads one of the project's own models without checks, because a tool of the project has written it.
///
/// # Errors
/// If a file is missing or differs from that tool's format.
pub fn load_own(path: &Path) -> Result<Model> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    let failed = || format!("{}: is not as the project has it", shown(path));
    let (models, materials) = tobj::load_obj(path, &options).with_context(failed)?;
    let materials = materials.with_context(failed)?;
    note_opened([path, &path.with_extension("mtl")]);
    let mut textures = Vec::new();
    let materials =
        materials.into_iter().map(|material| own_material(path, material, &mut textures));
    let materials = materials.collect::<Result<Vec<_>>>().with_context(failed)?;
    let meshes = models.into_iter().map(|model| mesh(model, 0)).collect();
    Ok(Model { meshes, materials, textures, ..Model::default() })
}

/// One of the project's own materials, and its textures, if they are not loaded yet.
fn own_material(
    model: &Path,
    material: tobj::Material,
    textures: &mut Vec<Texture>,
) -> Result<Material> {
    let mut texture = |name: Option<String>| -> Result<Option<usize>> {
        let Some(name) = name else { return Ok(None) };
        let known = textures.iter().position(|texture| texture.name == name);
        if known.is_none() {
            textures.push(Texture::open(&model.with_file_name(&name), name)?);
        }
        Ok(Some(known.unwrap_or(textures.len() - 1)))
    };
    let usual = Material::default();
    Ok(Material {
        name: material.name,
        base_color: material.diffuse.map_or(usual.base_color, Vec3::from),
        specular: material.specular.map_or(usual.specular, Vec3::from),
        shininess: material.shininess.unwrap_or(usual.shininess),
        emission: material.emissive.map_or(usual.emission, Vec3::from),
        opacity: material.dissolve.unwrap_or(usual.opacity),
        illumination: material.illumination_model.map_or(usual.illumination, u32::from),
        refraction: material.optical_density.unwrap_or(usual.refraction),
        base_texture: texture(material.diffuse_texture)?,
        opacity_texture: texture(material.dissolve_texture)?,
        ..usual
    })
}

/// A mesh in its form for shaders: normals of unit length, texture coordinates from the top.
fn mesh(model: tobj::Model, default_material: usize) -> Mesh {
    let tobj::Mesh { positions, normals, texcoords, indices, material_id, .. } = model.mesh;
    let position = |index: u32| Vec3::from_slice(&positions[3 * index as usize..]);
    let mut triangles: Vec<[u32; 3]> =
        indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    let mut vertices = Vec::with_capacity(positions.len() / 3);
    // The position of each vertex with a normal; the others stay with their triangle.
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

/// The normal of a counter-clockwise triangle; any direction if it has no area, because no ray hits it.
pub(crate) fn flat_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    // Products of very large or very small 32-bit numbers overflow or vanish in 32 bits.
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    if length > 0.0 { (normal / length).as_vec3() } else { Vec3::Y }
}

/// The vector with unit length, unless it is zero.
pub(crate) fn unit(vector: Vec3) -> Option<Vec3> {
    let vector = vector.as_dvec3();
    let length = vector.length();
    (length > 0.0).then(|| (vector / length).as_vec3())
}

#[cfg(test)]
pub(crate) mod tests;
