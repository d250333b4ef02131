//! MTL files, the materials of a model.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use anyhow::{Result, ensure};

use super::limits::Limits;
use super::mtl_keywords::Keyword;
use super::mtl_value::{BRIGHTEST, Value, after_options, has_late_option};
use super::text::{Folder, Named, Statement, Text, Unavailable, name, quoted};
use super::texture::{Role, SLOPES_PER_UNIT, Texture, TextureFiles};
use super::unseen::Places;
use super::warnings::{Kind, Warnings};
use crate::scene::material::Material;

/// The fault of a material with two maps of its relief.
const BOTH: &str = "the material has a normal map and a map of heights";

/// The advice where an option stands behind the name.
const LATE: &str = "; options come before the name";

/// The materials found so far in the MTL files of an OBJ file.
///
/// MTL is read here instead of by tobj, which has no line numbers, panics on the legal `Kd 0.5`, and leaves `Tr` and
/// everything about textures to its caller.
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
    /// For each material, the places of statements that may hide it.
    places: Vec<Places>,
    given: Given,
}

/// Statements about the current material so far, for those that override or complete another.
#[derive(Default)]
struct Given {
    opacity: bool,
    /// A normal map, which takes precedence over a map of heights.
    normals: bool,
    /// A map of heights.
    heights: bool,
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

    /// For each material, the places of the statements of a texture and of a normal map, if there are any.
    pub fn texture_places(&self) -> Vec<[Option<String>; 2]> {
        self.places.iter().map(|p| [p.texture.clone(), p.normals.clone()]).collect()
    }

    /// The materials, and the textures they index; adds warnings about unavailable ones, and about materials of
    /// which nothing would be seen.
    pub fn finish(self, limits: &Limits, warnings: &mut Warnings) -> (Vec<Material>, Vec<Texture>) {
        let Self { mut materials, textures, places, .. } = self;
        let (textures, positions) = textures.load(limits, warnings);
        for (material, places) in materials.iter_mut().zip(places) {
            for slot in material.textures() {
                *slot = slot.and_then(|file| positions[file]);
            }
            if material.normal_texture.is_some_and(|texture| textures[texture].slopes) {
                material.normal_scale /= SLOPES_PER_UNIT;
            }
            places.show(material, warnings);
        }
        (materials, textures)
    }

    /// Reads an MTL file. Keywords are read in upper and lower case; those of what is not shown get a warning, and so
    /// do wrong values.
    ///
    /// # Errors
    /// If it is too large, or a name too long, with file and line.
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
        let (word, rest) = statement.split()?;
        let keyword = match Keyword::of(word, rest) {
            Keyword::Read(keyword) => keyword,
            Keyword::PassedOver => return Ok(()),
            Keyword::LeftOut(names, what) => {
                let what = || format!("{word} {what}");
                warnings.add_word(Kind::Unread, names, statement, what);
                return Ok(());
            }
            Keyword::Unknown => {
                let what = || {
                    format!(
                        "{} is not a keyword of an MTL file, as newmtl, Kd, Ks, Ke, Ns, Ni, d, Tr, illum and \
                         map_Kd are",
                        quoted(word)
                    )
                };
                warnings.add_word(Kind::Line, word, statement, what);
                return Ok(());
            }
        };
        if keyword == "newmtl" {
            return self.start(material_name(word, rest)?, statement, warnings);
        }
        let mut value = Value { keyword, rest, statement, warnings };
        let (Some(material), Some(places)) = (self.materials.last_mut(), self.places.last_mut())
        else {
            value.leave_out(&format!("{keyword} stands before the first newmtl"));
            return Ok(());
        };
        let given = &mut self.given;
        if given.again {
            return Ok(());
        }
        let set = |slot: &mut f32, value: Option<f32>| *slot = value.unwrap_or(*slot);
        match keyword {
            "Kd" => {
                if let Some(color) = value.color(1.0) {
                    material.base_color = color;
                    places.color = Some(statement.place());
                }
            }
            "Ks" => material.specular = value.color(1.0).unwrap_or(material.specular),
            "Tf" => material.transmission = value.color(1.0).unwrap_or(material.transmission),
            "Ke" => material.emission = value.color(BRIGHTEST).unwrap_or(material.emission),
            "Ns" => set(&mut material.shininess, value.number(0.0, f32::MAX)),
            "Ni" => set(&mut material.refraction, value.number(1.0, f32::MAX)),
            "d" => {
                if let Some(rest) = rest.strip_prefix("-halo") {
                    value.pass_over("the option -halo");
                    value.rest = rest;
                }
                if let Some(opacity) = value.number(0.0, 1.0) {
                    material.opacity = opacity;
                    given.opacity = true;
                    places.opacity = (opacity == 0.0).then(|| statement.place());
                }
            }
            "Tr" => {
                // Old exporters wrote Tr as another name of d, so d takes precedence.
                let transparency = value.number(0.0, 1.0);
                if let Some(transparency) = transparency.filter(|_| !given.opacity) {
                    material.opacity = 1.0 - transparency;
                    places.opacity = (transparency == 1.0).then(|| statement.place());
                }
            }
            "Pr" => {
                if let Some(roughness) = value.number(0.0, 1.0) {
                    material.microfacet.get_or_insert_default().roughness = roughness;
                    places.has_roughness = true;
                }
            }
            "Pm" => {
                if let Some(metallic) = value.number(0.0, 1.0) {
                    material.microfacet.get_or_insert_default().metallic = metallic;
                }
            }
            "illum" => {
                if let Some(illumination) = value.illumination() {
                    material.illumination = illumination;
                    let is_glass = matches!(illumination, 4 | 6 | 7 | 9);
                    places.glass = is_glass.then(|| statement.place());
                }
            }
            _ => {
                let role = match keyword {
                    "map_Kd" => Role::Color,
                    "map_d" => Role::Opacity,
                    "map_Pr" | "map_Pm" => Role::Numbers,
                    "bump" | "map_Bump" => Role::Heights,
                    _ => Role::Normals,
                };
                given.heights |= role == Role::Heights;
                if role == Role::Heights && given.normals {
                    value.warnings.add(Kind::Relief, statement, || BOTH);
                    return Ok(());
                }
                let mut bumps = 1.0;
                let named =
                    after_options(rest, &mut |option: &str, argument: &str| match (option, role) {
                        ("-bm", Role::Heights | Role::Normals) => bumps = value.bumps(argument),
                        _ => value.pass_over(&format!("the option {option}")),
                    });
                let image = match folder.find(keyword, named, Some(file)) {
                    Ok(image) => image,
                    Err(error) => {
                        let hint = if has_late_option(named) { LATE } else { "" };
                        value.warnings.add(role.missing(), statement, || format!("{error}{hint}"));
                        return Ok(());
                    }
                };
                if let Some(instead) = &image.instead {
                    value.warnings.add(Kind::Elsewhere, statement, || instead);
                }
                let slot = match keyword {
                    "map_Kd" => &mut material.base_texture,
                    "map_d" => &mut material.opacity_texture,
                    "map_Pr" => &mut material.microfacet.get_or_insert_default().roughness_texture,
                    "map_Pm" => &mut material.microfacet.get_or_insert_default().metallic_texture,
                    _ => {
                        material.normal_scale = bumps;
                        given.normals |= role == Role::Normals;
                        if given.normals && given.heights {
                            value.warnings.add(Kind::Relief, statement, || BOTH);
                        }
                        &mut material.normal_texture
                    }
                };
                *slot = Some(self.textures.add(image, role, statement.place()));
                let place = Some(format!("{}: {keyword}", statement.place()));
                match role {
                    Role::Normals | Role::Heights => places.normals = place,
                    _ => places.texture = place,
                }
            }
        }
        Ok(())
    }

    fn start(&mut self, name: &str, statement: &Statement, warnings: &mut Warnings) -> Result<()> {
        self.given = Given::default();
        if let Some(first) = self.found.get(name) {
            let what = || format!("the material {} is defined at {first} already", quoted(name));
            warnings.add(Kind::Definition, statement, what);
            self.given.again = true;
            return Ok(());
        }
        self.found.insert(name.to_owned(), statement.place());
        self.materials.push(Material { name: name.to_owned(), ..Material::default() });
        self.places.push(Places::default());
        Ok(())
    }
}

/// The name of a material. Some exporters omit it in both files; then the OBJ file's empty name refers to the MTL
/// file's.
///
/// # Errors
/// If it is too long.
pub(crate) fn material_name<'a>(keyword: &str, rest: &'a str) -> Result<&'a str> {
    if rest.is_empty() { Ok("(no name)") } else { name(keyword, rest) }
}

#[cfg(test)]
mod tests;
