//! Loading an untrusted OBJ file with its MTL files and textures.

use std::path::Path;

use anyhow::{Result, ensure};
use glam::Vec3;

use super::glass::{is_body, turn_outwards};
use super::limits::Limits;
use super::obj::Model;
use super::obj_check::Check;
use super::parts::NONE;
use super::smoothing::smooth;
use super::text::{self, Folder, Text};
use super::warnings::Kind;
use crate::scene::material::Material;
use crate::scene::mesh::{LEAST, Mesh, REACH, around};

/// Reads an OBJ file with its MTL files and textures.
///
/// A new object, a new group in a file without objects, or another material starts a new mesh; faces of the same
/// object and material are in one mesh, wherever the file has them. Polygons become fans of triangles, and ears are
/// clipped from those that are not convex. A corner without a normal gets the mean of its smoothing group, or else
/// its triangle's: a cube must not be shaded like a ball. Texture coordinates are converted to Vulkan's, v
/// downwards; a corner without them gets (0, 0). A face without material gets [`Material::default`]. Lines, points
/// and curved surfaces are ignored.
///
/// Real files are often incomplete or a little wrong. What had to be left out or assumed is a line in
/// [`Model::warnings`], which says what to write.
///
/// # Errors
/// If the file is missing or has no faces that can be shown, if the model extends too far or is too small, needs too
/// much memory, or one of the files is too large; the message is one line with file and line number.
pub fn load(path: &Path) -> Result<Model> {
    checked(path, load_within(path, &Limits::DEFAULT, Place::AsWritten)?)
}

/// Reads an OBJ file as [`load`] does, and moves a model that is far from the origin there, in 64 bits: 32 bits
/// would lose its shape. A line in [`Model::warnings`] says by how much.
///
/// # Errors
/// As [`load`].
pub fn load_centered(path: &Path) -> Result<Model> {
    checked(path, load_within(path, &Limits::DEFAULT, Place::NearTheOrigin)?)
}

/// The place of a model that is far from the origin.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Place {
    AsWritten,
    NearTheOrigin,
}

/// The model, if rays can hit it.
fn checked(path: &Path, model: Model) -> Result<Model> {
    let reach = model.meshes.iter().map(Mesh::reach).fold(0.0, f32::max);
    ensure!(
        reach <= REACH,
        "{}: reaches {reach:e} from the origin; beyond {REACH:e}, products of four coordinates overflow in \
         32 bits",
        text::shown(path)
    );
    let (low, high) = around(model.meshes.iter().flat_map(|mesh| <[Vec3; 2]>::from(mesh.bounds())));
    let size = (high - low).max_element();
    ensure!(
        size == 0.0 || size >= LEAST,
        "{}: is {size:e} from end to end; below {LEAST:e}, products of two lengths vanish in 32 bits",
        text::shown(path)
    );
    Ok(model)
}

pub(crate) fn load_within(path: &Path, limits: &Limits, place: Place) -> Result<Model> {
    let folder = Folder::of(path)?;
    let text = Text::read(path, text::shown(path), limits.obj_bytes)?;
    let Check { mut geometry, names, library, mut warnings, .. } =
        Check::run(&text, &folder, limits)?;
    let shown = text.shown.clone();
    drop(text);
    let texture_places = library.texture_places();
    let (mut materials, textures) = library.finish(limits, &mut warnings);
    let far = geometry.positions.far(geometry.used()).map(|far| match place {
        Place::AsWritten => far.stays(),
        Place::NearTheOrigin => {
            geometry.positions.set_origin(far.middle);
            far.moved()
        }
    });
    smooth(&mut geometry);
    // The number of each material by the number of its name.
    let default = materials.len();
    let mut numbers = vec![default; names.len()];
    for (number, material) in materials.iter().enumerate() {
        if let Some(&name) = names.get(&material.name) {
            numbers[name as usize] = number;
        }
    }
    let numbers = geometry.join(|name| if name == NONE { default } else { numbers[name as usize] });
    if numbers.contains(&default) {
        materials.push(Material::default());
    }
    for (part, &material) in geometry.parts.iter().zip(&numbers) {
        let Some([texture, normals]) = texture_places.get(material) else { continue };
        if part.has_coordinates() {
            continue;
        }
        let has_normals = materials[material].normal_texture.is_some();
        let named = materials[material].textures().filter(|texture| texture.is_some()).count();
        let is_textured = named > usize::from(has_normals);
        for (kind, place, is_shown) in
            [(Kind::Untextured, texture, is_textured), (Kind::Unmapped, normals, has_normals)]
        {
            if let Some(place) = place.as_ref().filter(|_| is_shown) {
                let what = "is on faces without texture coordinates; write vt, and f with v/vt";
                warnings.add_many(kind, 1, || format!("{place} {what}"));
            }
        }
    }
    let ambiguous = geometry.ambiguous();
    let parts = std::mem::take(&mut geometry.parts);
    let mut meshes: Vec<_> =
        parts.into_iter().zip(numbers).map(|(part, number)| geometry.mesh(part, number)).collect();
    let mut warnings = warnings.lines();
    let bodies: Vec<bool> = meshes.iter().map(|mesh| is_body(&materials[mesh.material])).collect();
    warnings.extend(turn_outwards(&mut meshes, |mesh| bodies[mesh], &shown));
    warnings.extend(far.map(|what| format!("{shown}: {what}")));
    if !meshes.iter().any(Mesh::has_area) {
        let what = "none of its triangles has an area, and so nothing of it is seen";
        warnings.push(format!("{shown}: {what}"));
    }
    Ok(Model { meshes, materials, textures, warnings, ambiguous, ..Model::default() })
}
