//! Checks of an untrusted OBJ file.
//!
//! The text is checked statement by statement, so that every fault has a line number, and rewritten in a plain
//! form, which tobj then parses: only `v`, `vt`, `vn`, `f`, `o` and `usemtl`, every corner with all three indices.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::Vec3;

use super::glass::turn_outwards;
use super::index::{index, out_of_range, position};
use super::limits::Limits;
use super::mtl::{MaterialLibrary, material_name};
use super::obj::{self, Model};
use super::tally::Tally;
use super::text::{Folder, Named, Statement, Text, name, numbers, quoted, shown, uncommented};
use super::warnings::{Kind, Warnings};
use crate::scene::material::Material;
use crate::scene::mesh::{LEAST, Mesh, REACH, around};

/// The indices of corners without normal or texture coordinates; they are replaced when the parsed mesh is
/// converted for shaders.
const PREAMBLE: &str = "mtllib all\nvn 0 0 0\nvt 0 1\n";

/// The most corners of one face.
const CORNERS: usize = 1024;

/// Reads an OBJ file with its MTL files and textures.
///
/// A new object, a new group in a file without objects, or another material starts a new mesh. Polygons become
/// fans of triangles. A corner without a normal gets its triangle's: a cube must not be shaded like a ball, and
/// OBJ smooths only if the file says so. Texture coordinates are converted to Vulkan's, v downwards; a corner
/// without them gets (0, 0). A face without material gets [`Material::default`]. Lines, points, curved surfaces
/// and vertex colours are ignored.
///
/// Real files are often incomplete. For an MTL file or a texture that is missing or outside the OBJ file's folder, an
/// undefined material, a normal or texture coordinate out of range, or a statement of another format, the model is
/// loaded without it, with a line in [`Model::warnings`].
///
/// # Errors
/// If the file is missing or has no faces, if a vertex or a number in any of the files is wrong, if it extends too
/// far or is too small, needs too much memory, or one of the files is too large; the message is one line with file and
/// line number.
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

pub(crate) fn load_within(path: &Path, limits: &Limits) -> Result<Model> {
    let folder = Folder::of(path)?;
    let text = Text::read(path, shown(path), limits.obj_bytes)?;
    let Check { plain, library, mut warnings, .. } = Check::run(&text, &folder, limits)?;
    let (mut materials, textures) = library.finish(limits, &mut warnings);

    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    // Only names and positions: the contents of materials were read in the check.
    let names =
        materials.iter().enumerate().map(|(index, material)| (material.name.clone(), index));
    let names = |_: &Path| Ok((Vec::new(), names.clone().collect()));
    let parsed = tobj::load_obj_buf(&mut plain.as_bytes(), &options, names);
    let (models, _) = parsed.map_err(|error| anyhow!("{}: tobj: {error}", text.shown))?;

    let models = models.into_iter().filter(|model| !model.mesh.indices.is_empty());
    let default = materials.len();
    let mut meshes: Vec<_> = models.map(|model| obj::mesh(model, default)).collect();
    if meshes.iter().any(|mesh| mesh.material == default) {
        materials.push(Material::default());
    }
    let mut warnings = warnings.lines();
    let bodies: Vec<bool> = meshes.iter().map(|mesh| is_glass(&materials[mesh.material])).collect();
    warnings.extend(turn_outwards(&mut meshes, |mesh| bodies[mesh], &text.shown));
    if !meshes.iter().any(Mesh::has_area) {
        let what = "none of its triangles has an area, and so nothing of it is seen";
        warnings.push(format!("{}: {what}", text.shown));
    }
    Ok(Model { meshes, materials, textures, warnings })
}

/// True for the material of a body that refracts light.
fn is_glass(material: &Material) -> bool {
    matches!(material.illumination, 6 | 7)
}

/// The uses of a material that was undefined when it was first used.
struct Undefined {
    count: usize,
    /// Number of others found before it.
    order: usize,
    place: String,
}

/// The state of a check, statement by statement.
pub(crate) struct Check<'a> {
    /// The text for tobj.
    pub plain: String,
    /// The materials of the MTL files so far.
    pub library: MaterialLibrary,
    /// Faults that do not prevent the model from being shown.
    pub warnings: Warnings,
    /// The materials used before any MTL file defined them, each with the number of uses and the first.
    undefined: HashMap<String, Undefined>,
    tally: Tally,
    libraries: usize,
    has_objects: bool,
    limits: &'a Limits,
}

impl<'a> Check<'a> {
    /// Checks a whole file and its MTL files.
    ///
    /// # Errors
    /// On the first fault, with file and line.
    pub fn run(text: &Text, folder: &Folder, limits: &'a Limits) -> Result<Self> {
        let mut check = Self {
            plain: PREAMBLE.to_owned(),
            library: MaterialLibrary::default(),
            warnings: Warnings::default(),
            undefined: HashMap::new(),
            tally: Tally::default(),
            libraries: 0,
            has_objects: false,
            limits,
        };
        check.tally.text = text.size() + check.plain.len();
        let mut stray = None;
        for statement in text.statements() {
            let (keyword, rest) = statement.split().map_err(|error| statement.at(error))?;
            let before = check.plain.len();
            if keyword == "mtllib" {
                for file in check.libraries(rest, &statement, folder)? {
                    check.library.read(&file, folder, limits, &mut check.warnings)?;
                }
            } else if let Some(error) =
                check.statement(keyword, rest, &statement).map_err(|error| statement.at(error))?
            {
                check.warnings.add(Kind::Keyword, &statement, || &error);
                stray.get_or_insert_with(|| statement.at(error));
            }
            check.tally.text += check.plain.len() - before;
            if check.tally.bytes() > limits.memory {
                // The rest is read only to state the total.
                check.plain = String::new();
            }
        }
        // A file without faces but with other statements is not an OBJ file: report that instead.
        match stray {
            Some(stray) if check.tally.triangles == 0 => return Err(stray),
            _ => ensure!(check.tally.triangles > 0, "{}: has no faces", text.shown),
        }
        check.tally.check(limits).map_err(|error| anyhow!("{}: {error}", text.shown))?;
        check.tell_undefined();
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

    /// Handles a statement other than `mtllib`; returns the fault if it is not an OBJ statement.
    fn statement(
        &mut self,
        keyword: &str,
        rest: &str,
        statement: &Statement,
    ) -> Result<Option<String>> {
        match keyword {
            "v" => {
                let mut values = [0.0; 7];
                let words = match numbers(rest, &mut values)? {
                    // The last 3 of 6 or 7 are a colour.
                    3 | 6 | 7 => 3,
                    4 => {
                        let point = Vec3::from_slice(&values) / values[3];
                        ensure!(point.is_finite(), "a position divided by its w is not finite");
                        4
                    }
                    count => bail!("v has {count} numbers; x y z, x y z w or x y z r g b is right"),
                };
                self.tally.positions += 1;
                self.write(keyword, rest, words);
            }
            "vt" => {
                let count = numbers(rest, &mut [0.0; 3])?;
                ensure!(count > 0, "vt has no numbers; u, u v or u v w is right");
                self.tally.coordinates += 1;
                self.write(keyword, rest, count.min(2));
                if count == 1 {
                    self.plain.insert_str(self.plain.len() - 1, " 0");
                }
            }
            "vn" => {
                let count = numbers(rest, &mut [0.0; 3])?;
                ensure!(count == 3, "vn has {count} numbers; x y z is right");
                self.tally.normals += 1;
                self.write(keyword, rest, 3);
            }
            "f" => {
                let corners = self.face(uncommented(rest), statement)?;
                ensure!(corners >= 3, "a face has {corners} corners; it needs at least 3");
                self.tally.faces += 1;
                self.tally.corners += corners;
                self.tally.triangles += corners - 2;
            }
            "o" => {
                self.has_objects = true;
                self.start_mesh("o", rest)?;
            }
            "g" if !self.has_objects => self.start_mesh("o", rest)?,
            "usemtl" => {
                let material = material_name(keyword, rest)?;
                self.uses(material, statement);
                self.start_mesh(keyword, material)?;
            }
            "g" | "s" | "mg" | "l" | "p" | "vp" | "deg" | "bmat" | "step" | "cstype" | "curv"
            | "curv2" | "surf" | "parm" | "trim" | "hole" | "scrv" | "sp" | "end" | "con"
            | "bevel" | "c_interp" | "d_interp" | "lod" | "usemap" | "maplib" | "shadow_obj"
            | "trace_obj" | "ctech" | "stech" => {}
            _ => {
                // Text, not an error: that would capture a backtrace for each of a million lines.
                return Ok(Some(format!(
                    "{} is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl and mtllib are",
                    quoted(keyword)
                )));
            }
        }
        Ok(None)
    }

    fn write(&mut self, keyword: &str, rest: &str, words: usize) {
        self.plain.push_str(keyword);
        for word in rest.split_whitespace().take(words) {
            self.plain.push(' ');
            self.plain.push_str(word);
        }
        self.plain.push('\n');
    }

    fn start_mesh(&mut self, keyword: &str, rest: &str) -> Result<()> {
        let limit = self.limits.meshes;
        self.tally.meshes += 1;
        ensure!(
            self.tally.meshes <= limit,
            "more than {limit} objects and materials, the most that are read"
        );
        let name = if rest.is_empty() { "" } else { name(keyword, rest)? };
        writeln!(self.plain, "{keyword} {name}")?;
        Ok(())
    }

    fn face(&mut self, rest: &str, statement: &Statement) -> Result<usize> {
        self.plain.push('f');
        let mut corners = 0;
        for corner in rest.split_whitespace() {
            corners += 1;
            ensure!(
                corners <= CORNERS,
                "a face has more than {CORNERS} corners, the most that are read"
            );
            let mut parts = corner.split('/');
            let mut part = || parts.next().unwrap_or_default();
            let (v, vt, vn) = (part(), part(), part());
            ensure!(
                parts.next().is_none(),
                "the corner {} has too many parts; v, v/vt, v//vn or v/vt/vn is right",
                quoted(corner)
            );
            let v = index(v, "face")?;
            let Tally { positions, coordinates, normals, .. } = self.tally;
            let v = position(v, positions)
                .with_context(|| out_of_range(v, "face", positions, "positions"))?;
            // The preamble's come first, and replace missing ones and those out of range.
            let mut other = |word: &str, kind, count, of: &str, what| -> Result<usize> {
                if word.is_empty() {
                    return Ok(1);
                }
                let index = index(word, of)?;
                if let Some(position) = position(index, count) {
                    return Ok(1 + position);
                }
                self.warnings.add(kind, statement, || out_of_range(index, of, count, what));
                Ok(1)
            };
            let (of, what) = ("texture coordinate", "texture coordinates");
            let vt = other(vt, Kind::Coordinate, coordinates, of, what)?;
            let vn = other(vn, Kind::Normal, normals, "normal", "normals")?;
            write!(self.plain, " {v}/{vt}/{vn}")?;
        }
        self.plain.push('\n');
        Ok(corners)
    }
}

#[cfg(test)]
mod tests;
