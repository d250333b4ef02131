//! The MTL files that materials come from.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;

use super::material::Material;
use super::text::{
    Folder, Limits, Missing, Named, Statement, Text, name, numbers, quoted, uncommented,
};
use super::texture::{Role, Texture, TextureFiles};
use super::warnings::{Kind, Warnings};

/// The materials that an OBJ file has met so far.
///
/// MTL is read here and not by the parser of the OBJ file, which has no line numbers either, panics
/// on the legal `Kd 0.5`, and leaves `Tr` and everything about textures to its caller.
#[derive(Default)]
pub(super) struct MaterialLibrary {
    /// The materials in the order of the files.
    pub materials: Vec<Material>,
    /// The textures they name.
    textures: TextureFiles,
    /// Where each was defined first.
    found: HashMap<String, String>,
    read: HashSet<PathBuf>,
    /// The materials that have a colour of their own.
    colored: HashSet<usize>,
    given: Given,
}

/// What the current material has said, where one statement overrules or completes another.
#[derive(Default)]
struct Given {
    any: bool,
    opacity: bool,
    /// It has been defined before.
    again: bool,
}

impl MaterialLibrary {
    /// Whether a file has defined the material.
    pub fn defines(&self, material: &str) -> bool {
        self.found.contains_key(material)
    }

    /// What to say of a material that no file defines.
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

    /// The materials, and the textures that they index; those that cannot be had are warned of.
    pub fn finish(self, limits: &Limits, warnings: &mut Warnings) -> (Vec<Material>, Vec<Texture>) {
        let Self { mut materials, textures, colored, .. } = self;
        let (textures, positions) = textures.load(limits, warnings);
        for (number, material) in materials.iter_mut().enumerate() {
            for slot in [&mut material.base_texture, &mut material.opacity_texture] {
                *slot = slot.and_then(|file| positions[file]);
            }
            // The texture alone is meant, not half of it.
            if material.base_texture.is_some() && !colored.contains(&number) {
                material.base_color = Vec3::ONE;
            }
        }
        (materials, textures)
    }

    /// Reads an MTL file. Keywords that these samples do not use are passed over.
    ///
    /// # Errors
    /// On a value that is wrong, with file and line.
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
        let text = Text::read(&file.path, file.shown.clone(), limits.mtl_bytes)?;
        self.given = Given::default();
        for statement in text.statements() {
            self.statement(&statement, file, folder, warnings)
                .map_err(|error| statement.at(error))?;
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
        if !matches!(keyword, "Kd" | "Ks" | "Ke" | "Ns" | "d" | "Tr" | "illum" | "map_Kd" | "map_d")
        {
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
            "Kd" | "Ks" | "Ke" => {
                let Some(color) = color(keyword, rest, &mut pass_over)? else { return Ok(()) };
                match keyword {
                    "Kd" => {
                        material.base_color = color;
                        self.colored.insert(position);
                    }
                    "Ks" => material.specular = color,
                    _ => material.emission = color,
                }
            }
            "Ns" => material.shininess = number(keyword, rest, f32::MAX)?,
            "d" => {
                let value = rest.strip_prefix("-halo").inspect(|_| pass_over("the option -halo"));
                material.opacity = number(keyword, value.unwrap_or(rest), 1.0)?;
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
                let named = after_options(rest, &mut pass_over);
                let image = match folder.find(keyword, named, Some(file)) {
                    Err(error) if error.is::<Missing>() => {
                        warnings.add(Kind::Texture, statement, || error);
                        return Ok(());
                    }
                    image => image?,
                };
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

/// The name of a material. Exporters leave it out, and then in both files: the OBJ file's use is of what
/// the MTL file defines. tobj takes no empty one.
///
/// # Errors
/// If it is too long.
pub(super) fn material_name<'a>(keyword: &str, rest: &'a str) -> Result<&'a str> {
    if rest.is_empty() { Ok("(no name)") } else { name(keyword, rest) }
}

/// Three numbers from 0, or one for all three; `None` if it is given in a form that is passed over.
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

/// The name of a texture, which stands after the options.
fn after_options<'a>(rest: &'a str, pass_over: &mut impl FnMut(&str)) -> &'a str {
    let mut rest = rest;
    while let Some(option) = rest.split_whitespace().next().filter(|word| word.starts_with('-')) {
        // How many words an option takes at least; of offset, scale and turbulence, only the first is due.
        let (least, most) = match option {
            "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace"
            | "-imfchan" | "-texres" | "-type" => (1, 1),
            "-mm" => (2, 2),
            "-o" | "-s" | "-t" => (1, 3),
            // No option, but a name that starts so.
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

/// One number from 0 to `most`.
fn number(keyword: &str, rest: &str, most: f32) -> Result<f32> {
    let mut values = [0.0; 1];
    ensure!(numbers(rest, &mut values)? == 1, "{keyword} is not followed by a number");
    let [value] = values;
    ensure!(value >= 0.0, "{keyword} is {value}; it cannot be negative");
    ensure!(value <= most, "{keyword} is {value}; it cannot be more than {most}");
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::super::obj::tests::{TRIANGLE, load_files, load_text, warnings};
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
        line_refused("Ns -1", "Ns is -1; it cannot be negative");
        line_refused("Ns", "Ns is not followed by a number");
        line_refused("d 1.5", "d is 1.5; it cannot be more than 1");
        line_refused("illum 11", "illum \"11\" is not a whole number from 0 to 10");
        line_refused("illum", "illum \"\" is not a whole number from 0 to 10");
    }

    #[test]
    fn names_that_are_wrong() {
        let error = load_mtl("Kd 1 1 1\nnewmtl a\n").unwrap_err();
        assert_eq!(error, "m.mtl:1: Kd stands before the first newmtl");
        let files: [(&str, &[u8]); 3] = [
            ("model.obj", b"mtllib m.mtl n.mtl\n"),
            ("m.mtl", b"newmtl a\n"),
            ("n.mtl", b"\nNs 1\n"),
        ];
        let error = load_files(&files, &Limits::DEFAULT).unwrap_err();
        assert_eq!(error, "n.mtl:2: Ns stands before the first newmtl");
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
        refused("mtllib m.mtl ../m.mtl", &format!("mtllib names \"../m.mtl\", {outside}"));
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

    /// The warnings for a model that uses `a` on line 2.
    #[track_caller]
    fn warned(obj: &str, mtl: &str) -> Vec<String> {
        let obj = format!("{obj}usemtl a\n{TRIANGLE}");
        warnings(&[("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())])
    }

    #[test]
    fn materials_that_are_not_there_are_grey() {
        let grey = "a grey stands for it";
        let undefined = "the material \"a\" is not defined; the mtllib files hold";
        assert_eq!(
            warned("mtllib m.mtl\n", "newmtl b\nnewmtl c #2\n"),
            [format!("model.obj:2: {undefined} \"b\", \"c #2\"; {grey} (1 in all)")]
        );
        assert_eq!(
            warned("usemtl\n", ""),
            [format!(
                "model.obj:1: the material \"(no name)\" is not defined; the mtllib files hold no \
                 material; {grey} (2 in all)"
            )]
        );
        let unknown = "its materials are not known";
        assert_eq!(
            warned("mtllib gone.mtl\n", ""),
            [
                format!(
                    "model.obj:1: mtllib names \"gone.mtl\", which is not there; {unknown} (1 in all)"
                ),
                format!("model.obj:2: {undefined} no material; {grey} (1 in all)"),
            ]
        );
        let all = |obj: &str| warned(obj, "newmtl a\n");
        assert_eq!(
            all("mtllib\nmtllib gone a.mtl\nmtllib m.mtl gone.mtl\n"),
            [format!("model.obj:1: mtllib is not followed by a name; {unknown} (3 in all)")]
        );
        let spaces = format!(
            "model.obj:1: mtllib names \"gone a.mtl\", which is not there; {unknown} (1 in all)"
        );
        assert_eq!(all("mtllib gone a.mtl\nmtllib m.mtl\n"), [spaces]);
        assert_eq!(warned("mtllib m.mtl\nusemtl\n", "newmtl\nKd 1 0 0\nnewmtl a\n"), [""; 0]);
        // A file that comes after the use defines as well.
        assert_eq!(all("usemtl a\nmtllib m.mtl\n"), [""; 0]);
        let model = load_text(&format!("usemtl a\n{TRIANGLE}usemtl b\nf 1 2 3\n")).unwrap();
        assert_eq!(model.materials, [Material::default()]);
    }

    #[test]
    fn statements_that_are_not_supported_are_passed_over() {
        let mtl = "newmtl a\nKd 1 0 0\nKs spectral a.rfl 2\nKe xyz 1 1 1\nd -halo 0.5\n\
                   map_Kd -bm 0.2 gone.png\n";
        let files = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
        let files: [(&str, &[u8]); 2] =
            [("model.obj", files.as_bytes()), ("m.mtl", mtl.as_bytes())];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        assert_eq!(
            model.warnings,
            [
                "m.mtl:3: Ks has the form spectral, which is not supported; it is passed over (4 in all)",
                "m.mtl:6: map_Kd names \"gone.png\", which is not there; the plain colour stands for \
                 it (1 in all)",
            ]
        );
        let material = &model.materials[0];
        assert_eq!((material.base_color, material.opacity), (Vec3::X, 0.5));
        assert_eq!(material.base_texture, None);
    }

    #[test]
    fn options_stand_before_the_name_of_a_texture() {
        for (rest, name, count) in [
            ("t 1.png", "t 1.png", 0),
            ("-s 1 1 1 t.png", "t.png", 1),
            ("-s 2 1.png", "1.png", 1),
            ("-o 0.5 0 -bm 0.2 -clamp on my t.png", "my t.png", 3),
            ("-mm 0 1 -imfchan l -type sphere a.png", "a.png", 3),
            ("-strange.png", "-strange.png", 0),
            ("-bm", "", 1),
            ("", "", 0),
        ] {
            let mut options = 0;
            let found = after_options(rest, &mut |_: &str| options += 1);
            assert_eq!((found, options), (name, count), "{rest}");
        }
    }

    #[test]
    fn the_first_definition_of_a_material_stands() {
        let mtl = "newmtl a\nKd 1 0 0\nnewmtl b\nnewmtl a\nKd nonsense\nnewmtl c\nKd 0 0 1\n";
        let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
        let files: [(&str, &[u8]); 2] = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        let colors: Vec<_> = model.materials.iter().map(|m| m.base_color).collect();
        assert_eq!(colors, [Vec3::X, Vec3::splat(0.5), Vec3::Z]);
        let first = "m.mtl:4: the material \"a\" is defined at m.mtl:1 already";
        assert_eq!(model.warnings, [format!("{first}; the first definition stands (1 in all)")]);
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
