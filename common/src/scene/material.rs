//! A material, and the MTL files that materials come from.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;

use super::text::{Folder, Limits, Named, Text, name, numbers, quoted, uncommented};
use super::texture::{Role, TextureFiles};

/// How a surface looks, in the terms of an MTL file.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name, after `newmtl`.
    pub name: String,
    /// Diffuse reflectance, linear RGB (`Kd`); multiplies the base texture.
    pub base_color: Vec3,
    /// Specular reflectance, linear RGB (`Ks`).
    pub specular: Vec3,
    /// Exponent of the highlight (`Ns`).
    pub shininess: f32,
    /// Emitted radiance, linear RGB (`Ke`).
    pub emission: Vec3,
    /// 1 is opaque, 0 is not there (`d`, or else 1 - `Tr`).
    pub opacity: f32,
    /// The number of the illumination model, 0 to 10 (`illum`).
    pub illumination: u32,
    /// The texture whose RGB multiplies `base_color`, by position in the model (`map_Kd`).
    pub base_texture: Option<usize>,
    /// The texture whose alpha multiplies `opacity`, by position in the model (`map_d`).
    pub opacity_texture: Option<usize>,
}

impl Material {
    /// Whether rays may pass through some of the surface.
    pub fn has_cutout(&self) -> bool {
        self.opacity < 1.0 || self.opacity_texture.is_some()
    }

    /// Whether the surface reflects what is around it: the illumination model says so, and some light is
    /// reflected.
    pub fn is_mirror(&self) -> bool {
        self.illumination >= 3 && self.specular.max_element() > 0.0
    }
}

impl Default for Material {
    /// A mid-grey matte.
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            base_color: Vec3::splat(0.5),
            specular: Vec3::ZERO,
            shininess: 0.0,
            emission: Vec3::ZERO,
            opacity: 1.0,
            illumination: 1,
            base_texture: None,
            opacity_texture: None,
        }
    }
}

/// The materials that an OBJ file has met so far.
///
/// MTL is read here and not by the parser of the OBJ file, which has no line numbers either, panics
/// on the legal `Kd 0.5`, and leaves `Tr` and everything about textures to its caller.
#[derive(Default)]
pub(super) struct MaterialLibrary {
    /// The materials in the order of the files.
    pub materials: Vec<Material>,
    /// The textures they name.
    pub textures: TextureFiles,
    found: HashMap<String, (usize, String)>,
    read: HashSet<PathBuf>,
    given: Given,
}

/// What the current material has said, where one statement overrules or completes another.
#[derive(Default)]
struct Given {
    any: bool,
    base_color: bool,
    opacity: bool,
}

impl MaterialLibrary {
    /// The material of a name.
    ///
    /// # Errors
    /// If no file defines it.
    pub fn find(&self, material: &str) -> Result<usize> {
        let found = self.found.get(material).map(|&(index, _)| index);
        found.with_context(|| {
            let known: Vec<_> = self.materials.iter().take(5).map(|m| quoted(&m.name)).collect();
            let known = match self.materials.len() {
                0 => "no material".to_owned(),
                1..=5 => known.join(", "),
                more => format!("{} and {} more", known.join(", "), more - 5),
            };
            let material = quoted(material);
            format!("the material {material} is not defined; the mtllib files so far hold {known}")
        })
    }

    /// Reads an MTL file. Keywords that these samples do not use are passed over.
    ///
    /// # Errors
    /// On whatever is wrong in it, with file and line; on a second definition of a name.
    pub fn read(&mut self, file: &Named, folder: &Folder, limits: &Limits) -> Result<()> {
        if !self.read.insert(file.path.clone()) {
            return Ok(());
        }
        let text = Text::read(&file.path, file.shown.clone(), limits.mtl_bytes)?;
        self.given = Given::default();
        for statement in text.statements() {
            let (keyword, rest) = statement.split().map_err(|error| statement.at(error))?;
            let place = || statement.place();
            self.statement(keyword, rest, file, folder, place).map_err(|e| statement.at(e))?;
        }
        Ok(())
    }

    fn statement(
        &mut self,
        keyword: &str,
        rest: &str,
        file: &Named,
        folder: &Folder,
        place: impl Fn() -> String,
    ) -> Result<()> {
        if keyword == "newmtl" {
            return self.start(name(keyword, rest)?, place());
        }
        if !matches!(keyword, "Kd" | "Ks" | "Ke" | "Ns" | "d" | "Tr" | "illum" | "map_Kd" | "map_d")
        {
            return Ok(());
        }
        ensure!(self.given.any, "{keyword} stands before the first newmtl");
        let given = &mut self.given;
        let material = self.materials.last_mut().context("no material")?;
        match keyword {
            "Kd" => {
                material.base_color = color(keyword, rest)?;
                given.base_color = true;
            }
            "Ks" => material.specular = color(keyword, rest)?,
            "Ke" => material.emission = color(keyword, rest)?,
            "Ns" => material.shininess = number(keyword, rest, f32::MAX)?,
            "d" => {
                material.opacity = number(keyword, rest, 1.0)?;
                given.opacity = true;
            }
            "Tr" => {
                // Old exporters wrote Tr as another name of d, so d decides where there are both.
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
                ensure!(
                    !rest.starts_with('-'),
                    "{keyword} has the option {}; only a file name is supported",
                    quoted(rest.split_whitespace().next().unwrap_or_default())
                );
                let image = folder.find(keyword, rest, Some(file))?;
                if keyword == "map_Kd" {
                    material.base_texture = Some(self.textures.add(image, Role::Color, place()));
                    // The texture alone is meant, not half of it.
                    if !given.base_color {
                        material.base_color = Vec3::ONE;
                    }
                } else {
                    let index = self.textures.add(image, Role::Opacity, place());
                    material.opacity_texture = Some(index);
                }
            }
        }
        Ok(())
    }

    fn start(&mut self, name: &str, place: String) -> Result<()> {
        if let Some((_, first)) = self.found.get(name) {
            bail!("the material {} is defined at {first} already", quoted(name));
        }
        self.found.insert(name.to_owned(), (self.materials.len(), place));
        self.materials.push(Material { name: name.to_owned(), ..Material::default() });
        self.given = Given { any: true, ..Given::default() };
        Ok(())
    }
}

/// Three numbers from 0, or one for all three.
fn color(keyword: &str, rest: &str) -> Result<Vec3> {
    let first = rest.split_whitespace().next().unwrap_or_default();
    ensure!(
        !matches!(first, "spectral" | "xyz"),
        "{keyword} {first} is not supported; give red, green and blue"
    );
    let mut values = [0.0; 3];
    let color = match numbers(rest, &mut values)? {
        1 => Vec3::splat(values[0]),
        3 => Vec3::from(values),
        count => bail!("{keyword} has {count} numbers; a colour has 3, or 1 for a grey"),
    };
    ensure!(color.min_element() >= 0.0, "{keyword} has a negative number; a colour has none");
    Ok(color)
}

/// One number from 0 to `most`.
fn number(keyword: &str, rest: &str, most: f32) -> Result<f32> {
    ensure!(
        !rest.starts_with("-halo"),
        "{keyword} has the option \"-halo\"; only a number is supported"
    );
    let mut values = [0.0; 1];
    ensure!(numbers(rest, &mut values)? == 1, "{keyword} is not followed by a number");
    let [value] = values;
    ensure!(value >= 0.0, "{keyword} is {value}; it cannot be negative");
    ensure!(value <= most, "{keyword} is {value}; it cannot be more than {most}");
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::super::obj::tests::{TRIANGLE, load_files, load_text};
    use super::*;

    /// Reads an MTL file through an OBJ file that uses its first material.
    fn load_mtl(mtl: &str) -> Result<Material, String> {
        let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
        let files: [(&str, &[u8]); 2] = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
        let model = load_files(&files, &Limits::DEFAULT)?;
        Ok(model.materials[model.meshes[0].material].clone())
    }

    /// After `newmtl a`, line 2 is wrong.
    #[track_caller]
    fn line_refused(line: &str, message: &str) {
        let error = load_mtl(&format!("newmtl a\n{line}\nillum 1\n")).unwrap_err();
        assert_eq!(error, format!("m.mtl:2: {message}"));
    }

    #[test]
    fn every_statement_is_read() {
        let mtl = "# one\nnewmtl a\nKa 1 1 1\n Kd 0.1 0.2 0.3 # red\nKs 0.5\nKe 9 8 7\nNs 20\nNi 1.5\n\
                   d 0.25\nTr 0.1\nillum 2\nPr 0.3\nmap_Ks -s 1 1 1 nowhere.png\nmap_Bump ../x.png\n";
        let expected = Material {
            name: "a".to_owned(),
            base_color: Vec3::new(0.1, 0.2, 0.3),
            specular: Vec3::splat(0.5),
            shininess: 20.0,
            emission: Vec3::new(9.0, 8.0, 7.0),
            opacity: 0.25,
            illumination: 2,
            ..Material::default()
        };
        assert_eq!(load_mtl(mtl).unwrap(), expected);
        assert!(expected.has_cutout() && !Material::default().has_cutout());
        assert_eq!(load_mtl("newmtl a\r\nTr 0.25\r\n").unwrap().opacity, 0.75);
    }

    #[test]
    fn numbers_that_are_wrong() {
        line_refused("Kd red", "\"red\" is not a number");
        line_refused("Kd nan 0 0", "\"nan\" is not a finite 32-bit number");
        line_refused("Ke 0 1e40 0", "\"1e40\" is not a finite 32-bit number");
        line_refused("Kd 0 -0.5 0", "Kd has a negative number; a colour has none");
        line_refused("Ks 0 1", "Ks has 2 numbers; a colour has 3, or 1 for a grey");
        line_refused("Ks", "Ks has 0 numbers; a colour has 3, or 1 for a grey");
        line_refused("Kd spectral a.rfl", "Kd spectral is not supported; give red, green and blue");
        line_refused("Ns -1", "Ns is -1; it cannot be negative");
        line_refused("Ns", "Ns is not followed by a number");
        line_refused("d 1.5", "d is 1.5; it cannot be more than 1");
        line_refused("d -halo 0.5", "d has the option \"-halo\"; only a number is supported");
        line_refused("illum 11", "illum \"11\" is not a whole number from 0 to 10");
        line_refused("illum", "illum \"\" is not a whole number from 0 to 10");
    }

    #[test]
    fn names_that_are_wrong() {
        line_refused("newmtl", "newmtl is not followed by a name");
        line_refused("newmtl a", "the material \"a\" is defined at m.mtl:1 already");
        let error = load_mtl("Kd 1 1 1\nnewmtl a\n").unwrap_err();
        assert_eq!(error, "m.mtl:1: Kd stands before the first newmtl");
        let files: [(&str, &[u8]); 3] = [
            ("model.obj", b"mtllib m.mtl n.mtl\n"),
            ("m.mtl", b"newmtl a\n"),
            ("n.mtl", b"\nNs 1\n"),
        ];
        let error = load_files(&files, &Limits::DEFAULT).unwrap_err();
        assert_eq!(error, "n.mtl:2: Ns stands before the first newmtl");
        let error = load_mtl("newmtl b\nnewmtl c #2\n").unwrap_err();
        let known = "the mtllib files so far hold \"b\", \"c #2\"";
        assert_eq!(error, format!("model.obj:2: the material \"a\" is not defined; {known}"));
        let error = load_text("v 0 0 0\nusemtl\nf 1 1 1\n").unwrap_err();
        assert_eq!(error, "model.obj:2: usemtl is not followed by a name");
        let error = load_mtl("a\0b").unwrap_err();
        assert_eq!(error, "m.mtl:1: holds a zero byte: this is a binary file, not text");
    }

    #[test]
    fn files_that_are_wrong() {
        let refused = |line: &str, message: &str| {
            let error = load_text(&format!("\n{line}\n{TRIANGLE}")).unwrap_err();
            assert_eq!(error, format!("model.obj:2: {message}"));
        };
        let outside = "outside the OBJ file's folder; copy it into the folder";
        refused("mtllib gone.mtl", "mtllib names \"gone.mtl\", which is not there");
        refused("mtllib", "mtllib is not followed by a name");
        refused("mtllib ../m.mtl", &format!("mtllib names \"../m.mtl\", {outside}"));
        refused("mtllib /etc/passwd", &format!("mtllib names \"/etc/passwd\", {outside}"));
        refused("mtllib C:\\m.mtl", &format!("mtllib names \"C:\\\\m.mtl\", {outside}"));
        let error = load_text(&format!("mtllib .\n{TRIANGLE}")).unwrap_err();
        assert!(
            error.ends_with(": is not a file that can be read, but a folder or a device"),
            "{error}"
        );
        let files: [(&str, &[u8]); 2] =
            [("model.obj", b"mtllib m.mtl\n"), ("m.mtl", b"newmtl a\n")];
        let few = Limits { mtl_bytes: 8, ..Limits::DEFAULT };
        let error = load_files(&files, &few).unwrap_err();
        assert_eq!(error, "m.mtl: is too large: 9 bytes, at most 8 are read");
    }

    #[test]
    fn faces_without_material_get_the_default_after_the_others() {
        let obj =
            format!("{TRIANGLE}mtllib a b.mtl\nmtllib c.mtl sub/d.mtl c.mtl\nusemtl d\nf 1 2 3\n");
        let files: [(&str, &[u8]); 4] = [
            ("model.obj", obj.as_bytes()),
            ("a b.mtl", b"newmtl x\n"),
            ("c.mtl", b"newmtl c\n"),
            ("sub/d.mtl", b"newmtl d\n"),
        ];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        let names: Vec<_> = model.materials.iter().map(|material| &material.name).collect();
        assert_eq!(names, ["x", "c", "d", "default"]);
        assert_eq!(model.meshes.iter().map(|mesh| mesh.material).collect::<Vec<_>>(), [3, 2]);
        assert_eq!(model.materials[3], Material::default());
    }
}
