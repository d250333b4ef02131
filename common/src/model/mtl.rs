//! MTL files, the materials of a model.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;

use super::limits::Limits;
use super::text::{
    Folder, Named, Statement, Text, Unavailable, name, numbers, quoted, uncommented,
};
use super::texture::{Role, Texture, TextureFiles};
use super::warnings::{Kind, Warnings};
use crate::scene::material::Material;

/// The largest emission of a material, equal to the largest strength of a light in a scene file: sums of many
/// samples must not overflow.
const BRIGHTEST: f32 = 1e6;

/// The materials found so far in the MTL files of an OBJ file.
///
/// MTL is read here instead of by the parser of the OBJ file, which has no line numbers, panics on the legal `Kd
/// 0.5`, and leaves `Tr` and everything about textures to its caller.
#[derive(Default)]
pub(crate) struct MaterialLibrary {
    /// The materials in the order of the files.
    pub materials: Vec<Material>,
    /// The textures they name.
    textures: TextureFiles,
    /// The place of each material's first definition.
    found: HashMap<String, String>,
    read: HashSet<PathBuf>,
    /// Bytes of the files that were read.
    bytes: u64,
    /// The materials with a colour of their own.
    colored: HashSet<usize>,
    given: Given,
}

/// Statements about the current material so far, for those that override or complete another.
#[derive(Default)]
struct Given {
    any: bool,
    opacity: bool,
    /// It has been defined before.
    again: bool,
}

impl MaterialLibrary {
    /// True if a file has defined the material.
    pub fn defines(&self, material: &str) -> bool {
        self.found.contains_key(material)
    }

    /// The message for a material that no file defines.
    pub fn undefined(&self, material: &str) -> String {
        let known: Vec<_> = self.materials.iter().take(5).map(|m| quoted(&m.name)).collect();
        let known = match self.materials.len() {
            0 => "no material".to_owned(),
            1..=5 => known.join(", "),
            more => format!("{} and {} more", known.join(", "), more - 5),
        };
        let material = quoted(material);
        format!("the material {material} is not defined; the mtllib files hold {known}")
    }

    /// The materials, and the textures they index; adds warnings about unavailable ones.
    pub fn finish(self, limits: &Limits, warnings: &mut Warnings) -> (Vec<Material>, Vec<Texture>) {
        let Self { mut materials, textures, colored, .. } = self;
        let (textures, positions) = textures.load(limits, warnings);
        for (number, material) in materials.iter_mut().enumerate() {
            for slot in [&mut material.base_texture, &mut material.opacity_texture] {
                *slot = slot.and_then(|file| positions[file]);
            }
            // Without a `Kd`, the texture is used unchanged rather than multiplied by the default grey.
            if material.base_texture.is_some() && !colored.contains(&number) {
                material.base_color = Vec3::ONE;
            }
        }
        (materials, textures)
    }

    /// Reads an MTL file. Keywords that these samples do not use are ignored.
    ///
    /// # Errors
    /// On a wrong value, with file and line.
    pub fn read(
        &mut self,
        file: &Named,
        folder: &Folder,
        limits: &Limits,
        warnings: &mut Warnings,
    ) -> Result<()> {
        if !self.read.insert(file.path.clone()) {
            return Ok(());
        }
        let text = match Text::read(&file.path, file.shown.clone(), limits.mtl_bytes) {
            Ok(text) => text,
            Err(error) if !error.is::<Unavailable>() => return Err(error),
            Err(error) => {
                warnings.add_many(Kind::Library, 1, || error.to_string());
                return Ok(());
            }
        };
        self.bytes += text.size() as u64;
        ensure!(
            self.bytes <= limits.mtl_bytes,
            "{}: is too large: with the MTL files before it {} bytes, at most {} are read",
            file.shown,
            self.bytes,
            limits.mtl_bytes
        );
        self.given = Given::default();
        for statement in text.statements() {
            self.statement(&statement, file, folder, warnings)
                .map_err(|error| statement.at(error))?;
            let most = limits.materials;
            ensure!(
                self.materials.len() <= most,
                statement.at(format!("more than {most} materials, the most that are read"))
            );
        }
        Ok(())
    }

    fn statement(
        &mut self,
        statement: &Statement,
        file: &Named,
        folder: &Folder,
        warnings: &mut Warnings,
    ) -> Result<()> {
        let (keyword, rest) = statement.split()?;
        if keyword == "newmtl" {
            return self.start(material_name(keyword, rest)?, statement, warnings);
        }
        const READ: [&str; 11] =
            ["Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "illum", "map_Kd", "map_d"];
        if !READ.contains(&keyword) {
            return Ok(());
        }
        ensure!(self.given.any, "{keyword} stands before the first newmtl");
        if self.given.again {
            return Ok(());
        }
        let mut pass_over = |what: &str| {
            let what = || format!("{keyword} has {what}, which is not supported");
            warnings.add(Kind::Option, statement, what);
        };
        let given = &mut self.given;
        let position = self.materials.len().saturating_sub(1);
        let material = self.materials.last_mut().context("no material")?;
        match keyword {
            "Kd" | "Ks" | "Ke" | "Tf" => {
                let Some(color) = color(keyword, rest, &mut pass_over)? else { return Ok(()) };
                let most = color.max_element();
                ensure!(
                    most <= BRIGHTEST,
                    "{keyword} is {most:?}; it cannot be more than {BRIGHTEST}"
                );
                match keyword {
                    "Kd" => {
                        material.base_color = color;
                        self.colored.insert(position);
                    }
                    "Ks" => material.specular = color,
                    "Tf" => material.transmission = color,
                    _ => material.emission = color,
                }
            }
            "Ns" => material.shininess = number(keyword, rest, f32::MAX)?,
            "Ni" => material.refraction = number(keyword, rest, f32::MAX)?,
            "d" => {
                let value = rest.strip_prefix("-halo").inspect(|_| pass_over("the option -halo"));
                material.opacity = number(keyword, value.unwrap_or(rest), 1.0)?;
                given.opacity = true;
            }
            "Tr" => {
                // Old exporters wrote Tr as another name of d, so d takes precedence.
                let transparency = number(keyword, rest, 1.0)?;
                if !given.opacity {
                    material.opacity = 1.0 - transparency;
                }
            }
            "illum" => {
                let model = uncommented(rest).trim();
                let number = model.parse().ok().filter(|number| *number <= 10);
                material.illumination = number.with_context(|| {
                    format!("illum {} is not a whole number from 0 to 10", quoted(model))
                })?;
            }
            _ => {
                let named = after_options(rest, &mut pass_over);
                let image = match folder.find(keyword, named, Some(file)) {
                    Ok(image) => image,
                    Err(error) => {
                        warnings.add(Kind::Texture, statement, || error);
                        return Ok(());
                    }
                };
                if let Some(instead) = &image.instead {
                    warnings.add(Kind::Elsewhere, statement, || instead);
                }
                let (slot, role) = match keyword {
                    "map_Kd" => (&mut material.base_texture, Role::Color),
                    _ => (&mut material.opacity_texture, Role::Opacity),
                };
                *slot = Some(self.textures.add(image, role, statement.place()));
            }
        }
        Ok(())
    }

    fn start(&mut self, name: &str, statement: &Statement, warnings: &mut Warnings) -> Result<()> {
        self.given = Given { any: true, ..Given::default() };
        if let Some(first) = self.found.get(name) {
            let what = || format!("the material {} is defined at {first} already", quoted(name));
            warnings.add(Kind::Definition, statement, what);
            self.given.again = true;
            return Ok(());
        }
        self.found.insert(name.to_owned(), statement.place());
        self.materials.push(Material { name: name.to_owned(), ..Material::default() });
        Ok(())
    }
}

/// The name of a material. Some exporters omit it in both files; then the OBJ file's empty name refers to the MTL
/// file's. tobj does not accept an empty name.
///
/// # Errors
/// If it is too long.
pub(crate) fn material_name<'a>(keyword: &str, rest: &'a str) -> Result<&'a str> {
    if rest.is_empty() { Ok("(no name)") } else { name(keyword, rest) }
}

/// Three numbers from 0, or one for all three; `None` for an unsupported form.
fn color(keyword: &str, rest: &str, pass_over: &mut impl FnMut(&str)) -> Result<Option<Vec3>> {
    let first = rest.split_whitespace().next().unwrap_or_default();
    if matches!(first, "spectral" | "xyz") {
        pass_over(&format!("the form {first}"));
        return Ok(None);
    }
    let mut values = [0.0; 3];
    let color = match numbers(rest, &mut values)? {
        1 => Vec3::splat(values[0]),
        3 => Vec3::from(values),
        count => bail!("{keyword} has {count} numbers; a colour has 3, or 1 for a grey"),
    };
    ensure!(color.min_element() >= 0.0, "{keyword} has a negative number; a colour has none");
    Ok(Some(color))
}

/// The name of a texture, after the options.
fn after_options<'a>(rest: &'a str, pass_over: &mut impl FnMut(&str)) -> &'a str {
    let mut rest = rest;
    while let Some(option) = rest.split_whitespace().next().filter(|word| word.starts_with('-')) {
        // The minimum number of arguments of an option; of offset, scale and turbulence, only the first is required.
        let (least, most) = match option {
            "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace"
            | "-imfchan" | "-texres" | "-type" => (1, 1),
            "-mm" => (2, 2),
            "-o" | "-s" | "-t" => (1, 3),
            // Not an option, but a name that begins like one.
            _ => break,
        };
        pass_over(&format!("the option {option}"));
        rest = rest[option.len()..].trim_start();
        for taken in 0..most {
            let word = rest.split_whitespace().next().unwrap_or_default();
            if taken >= least && word.parse::<f32>().is_err() {
                break;
            }
            rest = rest[word.len()..].trim_start();
        }
    }
    rest
}

/// A single number from 0 to `most`.
fn number(keyword: &str, rest: &str, most: f32) -> Result<f32> {
    let mut values = [0.0; 1];
    ensure!(numbers(rest, &mut values)? == 1, "{keyword} is not followed by a number");
    let [value] = values;
    ensure!(value >= 0.0, "{keyword} is {value}; it cannot be negative");
    ensure!(value <= most, "{keyword} is {value}; it cannot be more than {most}");
    Ok(value)
}

#[cfg(test)]
mod tests;
