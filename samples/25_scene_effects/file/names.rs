//! Names in the tables of a scene file.

use std::collections::HashMap;

use anyhow::Result;
use common::model::Model;
use common::model::text::quoted;
use toml::Spanned;

use super::source::Source;
use crate::{Finish, rough_textures};

/// Positions by name: the first of several.
pub(super) type Numbers = HashMap<String, usize>;

/// The numbers of names.
pub(super) fn numbers<'a>(names: impl Iterator<Item = &'a String>) -> Numbers {
    let mut numbers = Numbers::new();
    for (number, name) in names.enumerate() {
        numbers.entry(name.clone()).or_insert(number);
    }
    numbers
}

/// The first of many names, on one line.
pub(super) fn some<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let bare = |name: &String| quoted(name).trim_matches('"').to_owned();
    names.take(20).map(bare).collect::<Vec<_>>().join(", ")
}

/// The material of a name.
///
/// # Errors
/// If there is none, with those that there are.
pub(super) fn find(
    model: &Model,
    materials: &Numbers,
    name: &Spanned<String>,
    source: &Source,
) -> Result<usize> {
    materials.get(name.get_ref()).copied().ok_or_else(|| {
        let what = match some(model.materials.iter().map(|material| &material.name)) {
            none if none.is_empty() => {
                format!("no material {}; add a [[material]]", quoted(name.get_ref()))
            }
            known => format!("no material {}; there is {known}", quoted(name.get_ref())),
        };
        source.error(name.span().start, &what)
    })
}

/// A material of a shape, which no any-hit shader asks for holes or texture coordinates, and which has no
/// edges of triangles.
pub(super) fn opaque(
    (model, finishes): (&Model, &[Finish]),
    materials: &Numbers,
    name: &Spanned<String>,
    source: &Source,
) -> Result<u32> {
    let number = find(model, materials, name, source)?;
    let material = &model.materials[number];
    let texture = material.base_texture.or(material.normal_texture).or(rough_textures(material));
    let textured = texture.is_some() || material.has_cutout();
    if textured || finishes[number].lines > 0.0 {
        let what = format!(
            "{} has holes, a texture or lines, which only meshes can have",
            quoted(&material.name)
        );
        Err(source.error(name.span().start, &what))
    } else {
        Ok(number as u32)
    }
}
