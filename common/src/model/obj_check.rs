//! The statements of an untrusted OBJ file, read one by one, so that every fault has a line number.

use std::borrow::Cow;
use std::collections::HashMap;

use anyhow::{Error, Result, anyhow, ensure};
use glam::{Vec2, Vec3};

use super::limits::Limits;
use super::mtl::{MaterialLibrary, material_name};
use super::number::words;
use super::parts::{Geometry, Parts};
use super::polygon::Triangulator;
use super::tally::Tally;
use super::text::{Folder, Named, Statement, Text, name, quoted};
use super::warnings::{Kind, Warnings};

/// Keywords that draw nothing: they name, group or describe what others draw.
const PASSED_OVER: [&str; 20] = [
    "g", "mg", "vp", "deg", "bmat", "step", "cstype", "parm", "trim", "hole", "scrv", "sp", "end",
    "con", "bevel", "c_interp", "d_interp", "lod", "ctech", "stech",
];

/// Keywords of what a viewer may draw and a ray cannot hit, or what is not read, with what is said of each.
const NOT_SHOWN: [(&str, &str); 9] = [
    ("l", "is a line, which no ray can hit; write faces"),
    ("p", "is a point, which no ray can hit; write faces"),
    ("curv", "is a curve, which no ray can hit; write faces"),
    ("curv2", "is a curve, which no ray can hit; write faces"),
    ("surf", "is a free-form surface, which is not read; export it as faces"),
    ("usemap", "is a texture of its own, which is not read; the map_Kd of a material is"),
    ("maplib", "is a file of textures, which is not read; the map_Kd of a material is"),
    ("shadow_obj", "is another body for shadows, which is not read; the faces cast them"),
    ("trace_obj", "is another body for reflections, which is not read; the faces are reflected"),
];

/// The uses of a material that was undefined when it was first used.
struct Undefined {
    count: usize,
    /// Number of others found before it.
    order: usize,
    place: String,
}

/// The state of a check, statement by statement.
pub(crate) struct Check<'a> {
    pub geometry: Geometry,
    /// The number of each name in a `usemtl` statement.
    pub names: HashMap<String, u32>,
    /// The materials of the MTL files so far.
    pub library: MaterialLibrary,
    /// Faults that do not prevent the model from being shown.
    pub warnings: Warnings,
    /// The materials used before any MTL file defined them, each with the number of uses and the first.
    undefined: HashMap<String, Undefined>,
    pub parts: Parts,
    pub smoothing: u32,
    pub triangulator: Triangulator,
    /// The first line or face that was left out: the reason why nothing is shown, if nothing is.
    left_out: Option<Error>,
    pub tally: Tally,
    libraries: usize,
    has_objects: bool,
    pub limits: &'a Limits,
}

impl<'a> Check<'a> {
    /// Reads a whole file and its MTL files.
    ///
    /// # Errors
    /// On the first fault with which it cannot be shown, with file and line.
    pub fn run(text: &Text, folder: &Folder, limits: &'a Limits) -> Result<Self> {
        let mut check = Self {
            geometry: Geometry::default(),
            names: HashMap::new(),
            library: MaterialLibrary::default(),
            warnings: Warnings::default(),
            undefined: HashMap::new(),
            parts: Parts::default(),
            smoothing: 0,
            triangulator: Triangulator::default(),
            left_out: None,
            tally: Tally { text: text.size(), ..Tally::default() },
            libraries: 0,
            has_objects: false,
            limits,
        };
        for statement in text.statements() {
            let (word, rest) = statement.split().map_err(|error| statement.at(error))?;
            let keyword = if word.bytes().any(|byte| byte.is_ascii_uppercase()) {
                Cow::Owned(word.to_ascii_lowercase())
            } else {
                Cow::Borrowed(word)
            };
            if keyword == "mtllib" {
                for file in check.libraries(rest, &statement, folder)? {
                    check.library.read(&file, folder, limits, &mut check.warnings)?;
                }
            } else if PASSED_OVER.contains(&&*keyword) && (keyword != "g" || check.has_objects) {
                continue;
            } else {
                check
                    .statement(&keyword, word, rest, &statement)
                    .map_err(|error| statement.at(error))?;
            }
        }
        // A file without faces but with other statements is not an OBJ file: report that instead.
        match check.left_out.take() {
            Some(error) if check.tally.triangles == 0 => return Err(error),
            _ => ensure!(check.tally.triangles > 0, "{}: has no faces", text.shown),
        }
        check.tally.check(limits).map_err(|error| anyhow!("{}: {error}", text.shown))?;
        check.tell_undefined();
        check.geometry.parts = std::mem::take(&mut check.parts).list;
        Ok(check)
    }

    /// The bytes needed for reading.
    #[cfg(test)]
    pub fn counted(&self) -> u64 {
        self.tally.bytes()
    }

    /// The MTL files named by a statement: one with spaces in its name, or several.
    fn libraries(
        &mut self,
        rest: &str,
        statement: &Statement,
        folder: &Folder,
    ) -> Result<Vec<Named>> {
        // One with spaces in its name, or several.
        self.libraries += rest.split_whitespace().count();
        let most = self.limits.libraries;
        ensure!(
            self.libraries <= most,
            statement.at(format!("more than {most} MTL files, the most that are looked for"))
        );
        let whole = folder.find("mtllib", rest, None);
        let is_exact = |found: &Result<Named, _>| matches!(found, Ok(Named { instead: None, .. }));
        let mut found = vec![whole];
        if !is_exact(&found[0]) && rest.contains(char::is_whitespace) {
            let parts = rest.split_whitespace().map(|part| folder.find("mtllib", part, None));
            let parts: Vec<_> = parts.collect();
            // If none of several exists, it was perhaps one with spaces in its name.
            if parts.iter().any(is_exact) {
                found = parts;
            }
        }
        let mut files = Vec::new();
        for found in found {
            match found {
                Ok(file) => {
                    if let Some(instead) = &file.instead {
                        self.warnings.add(Kind::Elsewhere, statement, || instead);
                    }
                    files.push(file);
                }
                Err(error) => self.warnings.add(Kind::Library, statement, || error),
            }
        }
        Ok(files)
    }

    /// Records a use of an undefined material; MTL files may still follow.
    fn uses(&mut self, material: &str, statement: &Statement) {
        if !self.library.defines(material) {
            let order = self.undefined.len();
            let first = || Undefined { count: 0, order, place: statement.place() };
            self.undefined.entry(material.to_owned()).or_insert_with(first).count += 1;
        }
    }

    /// Adds warnings about the materials that no MTL file defines.
    fn tell_undefined(&mut self) {
        let mut uses: Vec<_> = self.undefined.iter().collect();
        uses.retain(|(name, _)| !self.library.defines(name));
        uses.sort_by_key(|(_, uses)| uses.order);
        for (name, Undefined { count, place, .. }) in uses {
            let first = || format!("{place}: {}", self.library.undefined(name));
            self.warnings.add_many(Kind::Material, *count, first);
        }
    }

    /// Handles a statement other than `mtllib`; `word` is its keyword as the file has it.
    fn statement(
        &mut self,
        keyword: &str,
        word: &str,
        rest: &str,
        statement: &Statement,
    ) -> Result<()> {
        match keyword {
            "v" => self.position(rest, statement),
            "vt" => {
                let coordinate = self.coordinate(rest, statement).unwrap_or_else(|what| {
                    self.warnings.add(Kind::Coordinate, statement, || what);
                    // As without any: v is upwards here.
                    Vec2::Y
                });
                self.tally.coordinates += 1;
                self.geometry.coordinates.push(coordinate);
            }
            "vn" => {
                let normal = self.normal(rest, statement).unwrap_or_else(|what| {
                    self.warnings.add(Kind::Normal, statement, || what);
                    Vec3::ZERO
                });
                self.tally.normals += 1;
                self.geometry.normals.push(normal);
            }
            "f" => self.face(rest, statement)?,
            "o" => {
                self.has_objects = true;
                self.parts.start_object(if rest.is_empty() { "" } else { name(word, rest)? });
            }
            "g" => {
                let name = if rest.is_empty() { "" } else { name(word, rest)? };
                if self.parts.start_group(name) {
                    self.tally.text += name.len();
                }
            }
            "usemtl" => self.material(material_name(word, rest)?, statement)?,
            "s" => match words(rest).next().unwrap_or("off") {
                "off" | "OFF" | "Off" | "null" | "none" => self.smoothing = 0,
                "on" | "ON" | "On" => self.smoothing = 1,
                group => match group.parse() {
                    Ok(group) => self.smoothing = group,
                    Err(_) => {
                        let what = "is not a smoothing group, which is a whole number, or off";
                        self.leave_out(
                            Kind::Line,
                            "s",
                            statement,
                            format!("{} {what}", quoted(group)),
                        );
                    }
                },
            },
            _ if let Some((_, what)) = NOT_SHOWN.iter().find(|(other, _)| *other == keyword) => {
                self.leave_out(Kind::Unread, keyword, statement, format!("{keyword} {what}"));
            }
            _ => {
                let what = format!(
                    "{} is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl and mtllib are",
                    quoted(word)
                );
                self.leave_out(Kind::Line, word, statement, what);
            }
        }
        if self.tally.bytes() > self.limits.memory {
            // The rest is read only to state the total.
            self.geometry = Geometry::default();
            self.parts.list.iter_mut().for_each(|part| part.triangles = Vec::new());
        }
        Ok(())
    }

    /// Warns about a line that is left out.
    pub fn leave_out(&mut self, kind: Kind, word: &str, statement: &Statement, what: String) {
        self.warnings.add_word(kind, word, statement, || &what);
        self.left_out.get_or_insert_with(|| statement.at(what));
    }

    fn material(&mut self, material: &str, statement: &Statement) -> Result<()> {
        self.uses(material, statement);
        let number = match self.names.get(material) {
            Some(&number) => number,
            None => {
                self.count_mesh(0)?;
                let number = self.names.len() as u32;
                self.names.insert(material.to_owned(), number);
                number
            }
        };
        self.parts.set_material(number);
        Ok(())
    }

    /// Counts a mesh or a material, and the bytes of its name beyond the usual.
    pub fn count_mesh(&mut self, name: usize) -> Result<()> {
        let most = self.limits.meshes;
        self.tally.meshes += 1;
        self.tally.text += name;
        ensure!(
            self.tally.meshes <= most,
            "more than {most} objects and materials, the most that are read"
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests;
