//! Files that are scenes: models, and scene files of version 1.

mod bounded;
mod compose;
mod departure;
mod description;
mod names;
mod nesting;
mod polytope;
mod source;
mod tally;
#[cfg(test)]
mod tests;
mod values;
mod words;

use std::path::Path;

use anyhow::{Context, Result};
use common::model::text::shown;
use common::scene::{Look, Scene};
use description::Description;
use source::Source;
use toml::de::DeValue;

use crate::Composition;

/// Version of the format that this program reads.
const VERSION: i64 = 1;

/// Opens a scene file, or a plain model, under its lights or else a sun.
///
/// # Errors
/// If it is missing or wrong, in one line with file and line.
pub fn open(path: &Path) -> Result<Composition> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let mut scene = Composition::of_meshes(Scene::open(path)?);
        let told = departure::told(&scene).mesh.map(|what| format!("{}: {what}", shown(path)));
        scene.scene.model.warnings.extend(told);
        return checked(scene, path);
    }
    let source = Source::open(path)?;
    let table = source.table()?;
    // The version before the rest: what the rest means depends on it.
    let version = table.get_ref().get("version").and_then(|value| value.get_ref().as_integer());
    let version = version.and_then(|n| i64::from_str_radix(n.as_str(), n.radix()).ok());
    if version != Some(VERSION) {
        let at = source.line_of("version").unwrap_or(0);
        let what =
            format!("a scene file has the key `version = {VERSION}`; no other version is known");
        return Err(source.error(at, &what));
    }
    for name in words::ONCE {
        if let Some(value) = table.get_ref().get(name)
            && matches!(value.get_ref(), DeValue::Array(_))
        {
            let what = format!("there is one table of this name: write [{name}]");
            return Err(source.error(value.span().start, &what));
        }
    }
    checked(source.read::<Description>(table)?.compose(path, &source)?, path)
}

/// Warns of what is not shown, and checks that what shines can be listed.
fn checked(mut scene: Composition, path: &Path) -> Result<Composition> {
    let looks = [
        Look::Mirror,
        Look::Holes,
        Look::Transparency,
        Look::Glass,
        Look::Microfacet,
        Look::NormalMap,
    ];
    scene.scene.show_only(&looks, &shown(path).to_string());
    scene.lamps().with_context(|| shown(path))?;
    Ok(scene)
}
