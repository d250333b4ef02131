//! The check of an OBJ file before it is parsed, statement by statement: model files are not to be
//! trusted, and whatever is wrong in one has a line number.

use std::collections::HashMap;
use std::fmt::Write;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::Vec3;

use super::mtl::{MaterialLibrary, material_name};
use super::text::{
    Folder, Limits, Missing, Named, Statement, Text, name, numbers, quoted, uncommented,
};
use super::warnings::{Kind, Warnings};

/// Corners that are given no normal or no texture coordinates index these; what they mean is decided
/// where the parsed mesh is turned into one for shaders.
const PREAMBLE: &str = "mtllib all\nvn 0 0 0\nvt 0 1\n";

/// The most corners of one face.
const CORNERS: usize = 1024;

/// The uses of a material that was not defined when it was met.
struct Undefined {
    count: usize,
    /// How many others were met before it.
    order: usize,
    place: String,
}

/// One walk through the statements of an OBJ file.
pub(super) struct Check<'a> {
    /// The text that tobj parses.
    pub plain: String,
    /// The materials of the MTL files that were met.
    pub library: MaterialLibrary,
    /// What is wrong, but not so wrong that the model cannot be shown.
    pub warnings: Warnings,
    /// The materials that were used before any MTL file defined them, each with how often and where first.
    undefined: HashMap<String, Undefined>,
    positions: usize,
    coordinates: usize,
    normals: usize,
    triangles: usize,
    meshes: usize,
    has_objects: bool,
    limits: &'a Limits,
}

impl<'a> Check<'a> {
    /// Checks a whole file and the MTL files that it names.
    ///
    /// # Errors
    /// On whatever is wrong first, with file and line.
    pub fn run(text: &Text, folder: &Folder, limits: &'a Limits) -> Result<Self> {
        let mut check = Self {
            plain: PREAMBLE.to_owned(),
            library: MaterialLibrary::default(),
            warnings: Warnings::default(),
            undefined: HashMap::new(),
            positions: 0,
            coordinates: 0,
            normals: 0,
            triangles: 0,
            meshes: 0,
            has_objects: false,
            limits,
        };
        let mut stray = None;
        for statement in text.statements() {
            let (keyword, rest) = statement.split().map_err(|error| statement.at(error))?;
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
        }
        // What is without faces and of other statements is no OBJ file: that is what to tell.
        match stray {
            Some(stray) if check.triangles == 0 => return Err(stray),
            _ => ensure!(check.triangles > 0, "{}: has no faces", text.shown),
        }
        check.tell_undefined();
        Ok(check)
    }

    /// The MTL files that a statement names: one with spaces in its name, or several.
    fn libraries(
        &mut self,
        rest: &str,
        statement: &Statement,
        folder: &Folder,
    ) -> Result<Vec<Named>> {
        let mut missing = match folder.find("mtllib", rest, None) {
            Ok(file) => return Ok(vec![file]),
            Err(error) => vec![error],
        };
        let mut files = Vec::new();
        if rest.contains(char::is_whitespace) {
            let found = rest.split_whitespace().map(|part| folder.find("mtllib", part, None));
            let (found, parts): (Vec<_>, Vec<_>) = found.partition(Result::is_ok);
            files.extend(found.into_iter().flatten());
            let parts: Vec<_> = parts.into_iter().filter_map(Result::err).collect();
            // If none of several is there, it was perhaps one with spaces in its name.
            if !files.is_empty() || parts.iter().any(|error| !error.is::<Missing>()) {
                missing = parts;
            }
        }
        for error in missing {
            if !error.is::<Missing>() {
                return Err(statement.at(error));
            }
            self.warnings.add(Kind::Library, statement, || &error);
        }
        Ok(files)
    }

    /// Takes note of a material that is not defined; MTL files may still come.
    fn uses(&mut self, material: &str, statement: &Statement) {
        if !self.library.defines(material) {
            let order = self.undefined.len();
            let first = || Undefined { count: 0, order, place: statement.place() };
            self.undefined.entry(material.to_owned()).or_insert_with(first).count += 1;
        }
    }

    /// Warns of the materials that no MTL file defines.
    fn tell_undefined(&mut self) {
        let mut uses: Vec<_> = self.undefined.iter().collect();
        uses.retain(|(name, _)| !self.library.defines(name));
        uses.sort_by_key(|(_, uses)| uses.order);
        for (name, Undefined { count, place, .. }) in uses {
            let first = || format!("{place}: {}", self.library.undefined(name));
            self.warnings.add_many(Kind::Material, *count, first);
        }
    }

    /// Takes a statement other than `mtllib`; gives back what is wrong if it is none of an OBJ file.
    fn statement(
        &mut self,
        keyword: &str,
        rest: &str,
        statement: &Statement,
    ) -> Result<Option<anyhow::Error>> {
        let limit = self.limits.elements;
        let within = |count: usize, what| {
            ensure!(count <= limit, "more than {limit} {what}, the most that are read");
            Ok(())
        };
        match keyword {
            "v" => {
                let mut values = [0.0; 7];
                let words = match numbers(rest, &mut values)? {
                    // The rest of 6 or 7 is a colour.
                    3 | 6 | 7 => 3,
                    4 => {
                        let point = Vec3::from_slice(&values) / values[3];
                        ensure!(point.is_finite(), "a position divided by its w is not finite");
                        4
                    }
                    count => bail!("v has {count} numbers; x y z, x y z w or x y z r g b is right"),
                };
                self.positions += 1;
                within(self.positions, "positions")?;
                self.write(keyword, rest, words);
            }
            "vt" => {
                let count = numbers(rest, &mut [0.0; 3])?;
                ensure!(count > 0, "vt has no numbers; u, u v or u v w is right");
                self.coordinates += 1;
                within(self.coordinates, "texture coordinates")?;
                self.write(keyword, rest, count.min(2));
                if count == 1 {
                    self.plain.insert_str(self.plain.len() - 1, " 0");
                }
            }
            "vn" => {
                let count = numbers(rest, &mut [0.0; 3])?;
                ensure!(count == 3, "vn has {count} numbers; x y z is right");
                self.normals += 1;
                within(self.normals, "normals")?;
                self.write(keyword, rest, 3);
            }
            "f" => {
                let corners = self.face(uncommented(rest), statement)?;
                ensure!(corners >= 3, "a face has {corners} corners; it needs at least 3");
                self.triangles += corners - 2;
                within(self.triangles, "triangles")?;
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
                return Ok(Some(anyhow!(
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
        self.meshes += 1;
        ensure!(
            self.meshes <= limit,
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
            let v = position(v, self.positions)
                .with_context(|| out_of_range(v, "face", self.positions, "positions"))?;
            // The preamble's come first, and stand for what is not given or out of range.
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
            let vt = other(vt, Kind::Coordinate, self.coordinates, of, what)?;
            let vn = other(vn, Kind::Normal, self.normals, "normal", "normals")?;
            write!(self.plain, " {v}/{vt}/{vn}")?;
        }
        self.plain.push('\n');
        Ok(corners)
    }
}

/// An index of a face; it may be out of range.
fn index(word: &str, of: &str) -> Result<i64> {
    let index = word.parse().ok();
    index.with_context(|| format!("{of} index {} is not a whole number", quoted(word)))
}

/// An index as a position from 1, if it is in range. Negative ones count back from the last of `count`.
fn position(index: i64, count: usize) -> Option<usize> {
    let position = if index > 0 { index } else { index.saturating_add(count as i64 + 1) };
    usize::try_from(position).ok().filter(|position| (1..=count).contains(position))
}

fn out_of_range(index: i64, of: &str, count: usize, what: &str) -> String {
    match index {
        0 => format!("{of} index 0 is out of range: indices start at 1, or at -1 backwards"),
        _ => format!(
            "{of} index {index} is out of range: the file has {count} {what} up to this line"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::super::obj::load;
    use super::super::obj::tests::{load_files, load_text};
    use super::*;
    use std::path::Path;

    #[track_caller]
    fn refused(obj: &str, message: &str) {
        assert_eq!(load_text(obj).unwrap_err(), message);
    }

    /// After four positions, one normal and one texture coordinate, line 7 is wrong.
    #[track_caller]
    fn line_refused(line: &str, message: &str) {
        let good = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\n";
        refused(&format!("{good}{line}\nf 1 2 3\n"), &format!("model.obj:7: {message}"));
    }

    #[test]
    fn what_is_no_obj_file() {
        refused(
            "Once upon a time\n",
            "model.obj:1: \"Once\" is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl \
             and mtllib are",
        );
        refused("", "model.obj: has no faces");
        refused("# nothing\nv 0 0 0\no empty\nl 1 1\n", "model.obj: has no faces");
        refused("o a\n\0", "model.obj:2: holds a zero byte: this is a binary file, not text");
        let bytes = load_files(&[("model.obj", b"\xff\xfe\x80\n")], &Limits::DEFAULT);
        assert!(
            bytes.unwrap_err().starts_with("model.obj:1: \"\u{fffd}\u{fffd}\u{fffd}\" is not a")
        );
        let missing = load_files(&[], &Limits::DEFAULT);
        assert_eq!(missing.unwrap_err(), "model.obj: there is no such file");
        let folder = load_files(&[("model.obj/a", b"")], &Limits::DEFAULT);
        let message = "model.obj: is not a file that can be read, but a folder or a device";
        assert_eq!(folder.unwrap_err(), message);
        let nowhere = load(Path::new("no/such/folder/model.obj")).unwrap_err();
        assert_eq!(nowhere.to_string(), "no/such/folder/model.obj: there is no such file");
    }

    #[test]
    fn a_file_that_is_cut_off() {
        let hint = "; the file ends in this line, perhaps cut off";
        let face = "model.obj:4: a face has 2 corners; it needs at least 3";
        refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2", &format!("{face}{hint}"));
        let vertex = "model.obj:2: v has 2 numbers; x y z, x y z w or x y z r g b is right";
        refused("v 0 0 0\nv 1 0.", &format!("{vertex}{hint}"));
        refused("v 0 0 0\nv 1 -", &format!("model.obj:2: \"-\" is not a number{hint}"));
    }

    #[test]
    fn numbers_that_are_wrong() {
        line_refused("v 1,0 2 3", "\"1,0\" is not a number");
        line_refused("v 1 nan 3", "\"nan\" is not a finite 32-bit number");
        line_refused("vn inf 0 0", "\"inf\" is not a finite 32-bit number");
        line_refused("vt 0 1e39", "\"1e39\" is not a finite 32-bit number");
        line_refused("vn 0 1", "vn has 2 numbers; x y z is right");
        line_refused("vn 0 1 0 0", "more than 3 numbers");
        line_refused("vt # 0 0", "vt has no numbers; u, u v or u v w is right");
        line_refused("v 1 2 3 0", "a position divided by its w is not finite");
        line_refused("v 1 2 3e38 0.1", "a position divided by its w is not finite");
    }

    #[test]
    fn faces_that_are_wrong() {
        let whole = " is out of range: the file has";
        line_refused("f 1 2 99", &format!("face index 99{whole} 4 positions up to this line"));
        line_refused("f 1 2 -5", &format!("face index -5{whole} 4 positions up to this line"));
        line_refused(
            "f 1 2 0",
            "face index 0 is out of range: indices start at 1, or at -1 backwards",
        );
        line_refused("f 1 2 3.5", "face index \"3.5\" is not a whole number");
        line_refused("f 1 2 /1", "face index \"\" is not a whole number");
        line_refused(
            "f 1/1/1/1 2 3",
            "the corner \"1/1/1/1\" has too many parts; v, v/vt, v//vn or v/vt/vn is right",
        );
        line_refused("f 1 2 # 3", "a face has 2 corners; it needs at least 3");
        line_refused("f", "a face has 0 corners; it needs at least 3");
        let huge = format!("f 1 2 {}", i64::MIN);
        line_refused(&huge, &format!("face index {}{whole} 4 positions up to this line", i64::MIN));
        line_refused(
            &format!("f{}", " 1".repeat(1025)),
            "a face has more than 1024 corners, the most that are read",
        );
    }

    /// After four positions, one normal and one texture coordinate, lines from 7 on are warned of.
    #[track_caller]
    fn lines_warned(lines: &str, warnings: &[&str]) {
        let good = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\n";
        let model = load_text(&format!("{good}{lines}\nf 1 2 3\n")).unwrap();
        assert_eq!(model.warnings, warnings);
    }

    #[test]
    fn indices_that_a_model_can_do_without() {
        let whole = "is out of range: the file has 1";
        let none = "the corner has none";
        let flat = "the triangle's own stands for it";
        lines_warned(
            "f 1/1 2/2 3/1",
            &[&format!(
                "model.obj:7: texture coordinate index 2 {whole} texture coordinates up to this \
                 line; {none} (1 in all)"
            )],
        );
        lines_warned(
            "f 1//1 2//-2 3//1\nf 1//9 2//1 3//0",
            &[&format!(
                "model.obj:7: normal index -2 {whole} normals up to this line; {flat} (3 in all)"
            )],
        );
        lines_warned(
            "f 1//0 2/0 3/1/0",
            &[
                &format!(
                    "model.obj:7: normal index 0 is out of range: indices start at 1, or at -1 \
                     backwards; {flat} (2 in all)"
                ),
                &format!(
                    "model.obj:7: texture coordinate index 0 is out of range: indices start at 1, \
                     or at -1 backwards; {none} (1 in all)"
                ),
            ],
        );
        let model = load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//2 3/8\n").unwrap();
        let vertices = &model.meshes[0].vertices;
        let normals: Vec<_> = vertices.iter().map(|vertex| vertex.normal).collect();
        assert_eq!(normals, [Vec3::X, Vec3::Z, Vec3::Z]);
        assert!(vertices.iter().all(|vertex| vertex.uv == glam::Vec2::ZERO));
        line_refused("f 1//x 2 3", "normal index \"x\" is not a whole number");
    }

    #[test]
    fn statements_of_other_formats_are_passed_over() {
        let hint =
            "is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl and mtllib are";
        let warning = format!("model.obj:7: \"group\" {hint}; the line is passed over (2 in all)");
        lines_warned("group a b\ncurve 1 2\nF 1 2", &[&warning.replace("2 in", "3 in")]);
        lines_warned("group\nxyz", &[&warning]);
        let known = "l 1 2\np 1\ns off\nvp 0.5\ncstype bezier\ndeg 3\ncurv 0 1 1 2\nend\nlod 2\n\
                     bevel on\nshadow_obj a.obj\nmg 1 0.5";
        lines_warned(known, &[]);
    }

    #[test]
    fn more_than_the_limits() {
        let few = Limits { elements: 3, meshes: 1, obj_bytes: 100, ..Limits::DEFAULT };
        let most = ", the most that are read";
        for (obj, message) in [
            ("v 0 0 0\n".repeat(4), format!(":4: more than 3 positions{most}")),
            ("vn 0 0 0\n".repeat(4), format!(":4: more than 3 normals{most}")),
            ("vt 0\n".repeat(4), format!(":4: more than 3 texture coordinates{most}")),
            ("v 0 0 0\nf 1 1 1 1 1\nf 1 1 1\n".into(), format!(":3: more than 3 triangles{most}")),
            ("o a\no b\n".into(), format!(":2: more than 1 objects and materials{most}")),
            (" ".repeat(101), ": is too large: 101 bytes, at most 100 are read".into()),
        ] {
            let error = load_files(&[("model.obj", obj.as_bytes())], &few).unwrap_err();
            assert_eq!(error, format!("model.obj{message}"));
        }
        let long = format!("o a\nv {}\n", "0 ".repeat(40_000));
        refused(&long, "model.obj:2: the line is too long: 80001 bytes, at most 65536 are read");
        let name = format!("o {}\n", "a".repeat(1025));
        refused(&name, "model.obj:1: the name is too long: 1025 bytes, at most 1024 are read");
        // A real file of too many bytes, without writing them.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.obj");
        std::fs::File::create(&path).unwrap().set_len((512 << 20) + 1).unwrap();
        let message = load(&path).unwrap_err().to_string();
        assert!(
            message
                .ends_with("model.obj: is too large: 536870913 bytes, at most 536870912 are read"),
            "{message}"
        );
    }
}
