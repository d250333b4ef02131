//! The check of an OBJ file before it is parsed, statement by statement: model files are not to be
//! trusted, and whatever is wrong in one has a line number.

use std::fmt::Write;

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;

use super::material::MaterialLibrary;
use super::text::{Folder, Limits, Text, name, numbers, quoted, uncommented};

/// Corners that are given no normal or no texture coordinates index these; what they mean is decided
/// where the parsed mesh is turned into one for shaders.
const PREAMBLE: &str = "mtllib all\nvn 0 0 0\nvt 0 1\n";

/// The most corners of one face.
const CORNERS: usize = 1024;

/// One walk through the statements of an OBJ file.
pub(super) struct Check<'a> {
    /// The text that tobj parses.
    pub plain: String,
    /// The materials of the MTL files that were met.
    pub library: MaterialLibrary,
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
            positions: 0,
            coordinates: 0,
            normals: 0,
            triangles: 0,
            meshes: 0,
            has_objects: false,
            limits,
        };
        for statement in text.statements() {
            let (keyword, rest) = statement.split().map_err(|error| statement.at(error))?;
            if keyword == "mtllib" {
                // Several files may be named, and one name may have spaces: the latter comes first.
                let files = match folder.find(keyword, rest, None) {
                    Err(_) if rest.contains(char::is_whitespace) => rest
                        .split_whitespace()
                        .map(|part| folder.find(keyword, part, None))
                        .collect(),
                    found => found.map(|file| vec![file]),
                };
                for file in files.map_err(|error| statement.at(error))? {
                    check.library.read(&file, folder, limits)?;
                }
            } else {
                check.statement(keyword, rest).map_err(|error| statement.at(error))?;
            }
        }
        ensure!(check.triangles > 0, "{}: has no faces", text.shown);
        Ok(check)
    }

    fn statement(&mut self, keyword: &str, rest: &str) -> Result<()> {
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
                let corners = self.face(uncommented(rest))?;
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
                self.library.find(name(keyword, rest)?)?;
                self.start_mesh(keyword, rest)?;
            }
            "g" | "s" | "mg" | "l" | "p" | "vp" | "deg" | "bmat" | "step" | "cstype" | "curv"
            | "curv2" | "surf" | "parm" | "trim" | "hole" | "scrv" | "sp" | "end" | "con"
            | "bevel" | "c_interp" | "d_interp" | "lod" | "usemap" | "maplib" | "shadow_obj"
            | "trace_obj" | "ctech" | "stech" => {}
            _ => bail!(
                "{} is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl and mtllib are",
                quoted(keyword)
            ),
        }
        Ok(())
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

    fn face(&mut self, rest: &str) -> Result<usize> {
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
            let v = index(v, self.positions, "face", "positions")?;
            // The preamble's come first.
            let vt = match vt {
                "" => 1,
                vt => 1 + index(vt, self.coordinates, "texture coordinate", "texture coordinates")?,
            };
            let vn = match vn {
                "" => 1,
                vn => 1 + index(vn, self.normals, "normal", "normals")?,
            };
            write!(self.plain, " {v}/{vt}/{vn}")?;
        }
        self.plain.push('\n');
        Ok(corners)
    }
}

/// An index of a face as a position from 1. Negative ones count back from the last of `count`.
fn index(word: &str, count: usize, of: &str, what: &str) -> Result<usize> {
    let index: i64 = word
        .parse()
        .ok()
        .with_context(|| format!("{of} index {} is not a whole number", quoted(word)))?;
    ensure!(index != 0, "{of} index 0 is out of range: indices start at 1, or at -1 backwards");
    let position = if index > 0 { index } else { index.saturating_add(count as i64 + 1) };
    let position = usize::try_from(position).ok().filter(|position| (1..=count).contains(position));
    position.with_context(|| {
        format!("{of} index {index} is out of range: the file has {count} {what} up to this line")
    })
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
        let coordinate = format!("texture coordinate index 2{whole} 1 texture coordinates");
        line_refused("f 1/1 2/2 3/1", &format!("{coordinate} up to this line"));
        line_refused(
            "f 1//1 2//-2 3//1",
            &format!("normal index -2{whole} 1 normals up to this line"),
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
