//! Reading an OBJ file: its meshes, and the materials and textures that it names.
//!
//! The text is checked statement by statement and written out again in a plain form, which tobj then
//! parses: only `v`, `vt`, `vn`, `f`, `o` and `usemtl`, every corner with all three indices.

use std::fmt::Write;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::{Vec2, Vec3};

use super::material::{Material, MaterialLibrary};
use super::mesh::{Mesh, Vertex};
use super::obj_check::{Folder, Limits, Text, name, numbers, quoted, shown, uncommented};
use super::texture::Texture;

/// All that an OBJ file holds and names.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The meshes in the file's order; at least one, none without triangles.
    pub meshes: Vec<Mesh>,
    /// The materials that meshes index.
    pub materials: Vec<Material>,
    /// The textures that materials index.
    pub textures: Vec<Texture>,
}

/// Reads an OBJ file with its MTL files and PNG textures.
///
/// A new object, a new group in a file without objects, or another material starts a new mesh.
/// Polygons become fans of triangles. Corners without a normal get that of their triangle, for OBJ
/// smooths only where a file asks for it and a cube must not be shaded as a ball. Texture coordinates
/// are turned to Vulkan's, v downwards; corners without get (0, 0). Faces without material get
/// [`Material::default`]. Lines, points, curved surfaces and vertex colours are passed over.
///
/// # Errors
/// If any of the files is missing, wrong, too large, or outside the OBJ file's folder; the message is
/// one line with file and line number.
pub fn load(path: &Path) -> Result<Model> {
    load_within(path, &Limits::DEFAULT)
}

fn load_within(path: &Path, limits: &Limits) -> Result<Model> {
    let folder = Folder::of(path)?;
    let text = Text::read(path, shown(path), limits.obj_bytes)?;
    let check = Check::run(&text, &folder, limits)?;
    let MaterialLibrary { mut materials, textures, .. } = check.library;

    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    // Only names and positions: what the materials hold was read in the check.
    let names =
        materials.iter().enumerate().map(|(index, material)| (material.name.clone(), index));
    let names = |_: &Path| Ok((Vec::new(), names.clone().collect()));
    let parsed = tobj::load_obj_buf(&mut check.plain.as_bytes(), &options, names);
    let (models, _) = parsed.map_err(|error| anyhow!("{}: tobj: {error}", text.shown))?;

    let models = models.into_iter().filter(|model| !model.mesh.indices.is_empty());
    let default = materials.len();
    let meshes: Vec<_> = models.map(|model| mesh(model, default)).collect();
    if meshes.iter().any(|mesh| mesh.material == default) {
        materials.push(Material::default());
    }
    Ok(Model { meshes, materials, textures: textures.load(limits)? })
}

/// Corners that are given no normal or no texture coordinates index these; their meaning is in
/// [`mesh`].
const PREAMBLE: &str = "mtllib all\nvn 0 0 0\nvt 0 1\n";

/// The most corners of one face.
const CORNERS: usize = 1024;

/// One walk through the statements of an OBJ file.
struct Check<'a> {
    plain: String,
    library: MaterialLibrary,
    positions: usize,
    coordinates: usize,
    normals: usize,
    triangles: usize,
    meshes: usize,
    has_objects: bool,
    limits: &'a Limits,
}

impl<'a> Check<'a> {
    fn run(text: &Text, folder: &Folder, limits: &'a Limits) -> Result<Self> {
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

/// A mesh as shaders want it: normals of unit length, texture coordinates from the top.
fn mesh(model: tobj::Model, default_material: usize) -> Mesh {
    let tobj::Mesh { positions, normals, texcoords, indices, material_id, .. } = model.mesh;
    let position = |index: u32| Vec3::from_slice(&positions[3 * index as usize..]);
    let mut triangles: Vec<[u32; 3]> =
        indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    let mut vertices = Vec::with_capacity(positions.len() / 3);
    // Where a vertex with a normal went; the others stay with their triangle.
    let mut moved = vec![None; positions.len() / 3];
    for triangle in &mut triangles {
        let flat = flat_normal(triangle.map(position));
        for corner in triangle {
            let from = *corner as usize;
            let normal = unit(Vec3::from_slice(&normals[3 * from..]));
            *corner = moved[from].unwrap_or_else(|| {
                let uv = Vec2::new(texcoords[2 * from], 1.0 - texcoords[2 * from + 1]);
                let normal = normal.unwrap_or(flat);
                vertices.push(Vertex { position: position(*corner), normal, uv });
                vertices.len() as u32 - 1
            });
            moved[from] = normal.map(|_| *corner);
        }
    }
    let material = material_id.unwrap_or(default_material);
    Mesh { name: model.name, vertices, triangles, material }
}

/// The normal of a counter-clockwise triangle; any direction if it has no area, as no ray meets it.
fn flat_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    // Products of 32-bit numbers that are large or small enough overflow or vanish in 32 bits.
    let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    if length > 0.0 { (normal / length).as_vec3() } else { Vec3::Y }
}

/// The vector with unit length, unless it is zero.
fn unit(vector: Vec3) -> Option<Vec3> {
    let vector = vector.as_dvec3();
    let length = vector.length();
    (length > 0.0).then(|| (vector / length).as_vec3())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::scene::assets;
    use proptest::prelude::*;
    use std::path::MAIN_SEPARATOR;

    pub const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    /// Writes files into a folder of their own and reads `model.obj`, in which errors are one line;
    /// its paths are relative to the folder.
    pub fn load_files(files: &[(&str, &[u8])], limits: &Limits) -> Result<Model, String> {
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        }
        load_within(&folder.path().join("model.obj"), limits).map_err(|error| {
            let line = format!("{error:#}")
                .replace(&format!("{}{MAIN_SEPARATOR}", folder.path().display()), "");
            assert!(!line.contains('\n'), "{line}");
            line
        })
    }

    pub fn load_text(obj: &str) -> Result<Model, String> {
        load_files(&[("model.obj", obj.as_bytes())], &Limits::DEFAULT)
    }

    fn only_mesh(obj: &str) -> Mesh {
        let model = load_text(obj).unwrap();
        assert_eq!(model.meshes.len(), 1);
        model.meshes[0].clone()
    }

    fn positions(mesh: &Mesh) -> Vec<[Vec3; 3]> {
        let position = |index: u32| mesh.vertices[index as usize].position;
        mesh.triangles.iter().map(|triangle| triangle.map(position)).collect()
    }

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

    #[test]
    fn polygons_become_fans() {
        let [a, b, c, d, e] =
            [[0., 0.], [2., 0.], [3., 1.], [2., 2.], [0., 2.]].map(|[x, y]| Vec3::new(x, y, 0.));
        let obj = "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\n";
        let quad = only_mesh(&format!("{obj}f 1 2 4 5\n"));
        assert_eq!(positions(&quad), [[a, b, d], [a, d, e]]);
        let polygon = only_mesh(&format!("{obj}f 1 2 3 4 5\n"));
        assert_eq!(positions(&polygon), [[a, b, c], [a, c, d], [a, d, e]]);
        assert_eq!(only_mesh(&format!("{obj}f -5 -4 -2 -1\n")), quad);
        assert_eq!(
            only_mesh(&format!("{obj}vt 0 1\nvn 0 0 7\nf 1/1/1 2/1/-1 4//1 5/-1/1\n")).triangles,
            [[0, 1, 2], [0, 2, 3]]
        );
    }

    #[test]
    fn forms_that_people_really_have() {
        let plain = only_mesh(TRIANGLE);
        for same in [
            TRIANGLE.replace('\n', "\r\n"),
            TRIANGLE.replace('\n', "\r"),
            TRIANGLE.replace(' ', "\t  "),
            TRIANGLE.trim_end().to_owned(),
            TRIANGLE.replace("f 1 2 3", "f 1 \\\n  2 \\\r\n3"),
            TRIANGLE.replace("f 1 2 3", "f 1 2 3\\"),
            TRIANGLE.replace("v 0 1 0", "# C:\\models\\\n\nv 0 1 0 # up"),
            TRIANGLE.replace("v 0 1 0", "v 0 1 0 # C:\\models\\"),
            TRIANGLE.replace("v 1 0 0", "v 1 0 0 0.5 0.5 1e-9"),
            TRIANGLE.replace("v 1 0 0", "v 2 0 0 2"),
            TRIANGLE.replace("f 1 2 3", "s off\nl 1 2\np 1\nvp 0 0\nvt 0.5\nf 1/ 2// 3"),
            format!("\u{feff}{TRIANGLE}"),
        ] {
            assert_eq!(only_mesh(&same), plain, "{same:?}");
        }
        let latin = [b"o caf\xe9\n", TRIANGLE.as_bytes()].concat();
        let latin = load_files(&[("model.obj", &latin)], &Limits::DEFAULT).unwrap();
        assert_eq!(latin.meshes[0].name, "caf\u{fffd}");
    }

    #[test]
    fn missing_normals_are_flat_and_given_ones_are_of_unit_length() {
        let mesh = only_mesh(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 3 4\nvn 0 0 0\nf 1 2 3\nf 1//1 3//2 4\n",
        );
        let normals: Vec<_> = mesh
            .triangles
            .as_flattened()
            .iter()
            .map(|&i| mesh.vertices[i as usize].normal)
            .collect();
        assert_eq!(
            normals,
            [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::new(0.0, 0.6, 0.8), Vec3::X, Vec3::X]
        );
        let tiny = only_mesh(
            "v 0 0 0\nv 1e-45 0 0\nv 0 0 -1e-45\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\nf 1 4 5\nf 1 1 2\n",
        );
        let normals: Vec<_> =
            tiny.triangles.iter().map(|t| tiny.vertices[t[0] as usize].normal).collect();
        assert_eq!(normals, [Vec3::Y, Vec3::Z, Vec3::Y]);
    }

    #[test]
    fn texture_coordinates_start_at_the_top() {
        let mesh = only_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0\nvt 0.5 0.75 9\nf 1/1 2/2 3\n");
        let uv: Vec<_> = mesh.triangles[0].iter().map(|&i| mesh.vertices[i as usize].uv).collect();
        assert_eq!(uv, [Vec2::new(0.25, 1.0), Vec2::new(0.5, 0.25), Vec2::ZERO]);
    }

    #[test]
    fn objects_or_groups_name_meshes_and_share_vertices() {
        let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n";
        let names = |obj: &str| -> Vec<String> {
            load_text(&format!("{faces}{obj}"))
                .unwrap()
                .meshes
                .into_iter()
                .map(|mesh| mesh.name)
                .collect()
        };
        assert_eq!(names("o a #2\nf 1 2 3\no empty\no b c\nf 1 2 3\no end\n"), ["a #2", "b c"]);
        assert_eq!(names("g a\nf 1 2 3\ng b\nf 1 2 3\n"), ["a", "b"]);
        assert_eq!(names("o a\ng x\nf 1 2 3\ng y\nf 1 2 3\n"), ["a"]);
        let mesh = only_mesh(&format!("{faces}f 1//1 2//1 3//1\nf 3//1 2//1 1//1\n"));
        assert_eq!((mesh.vertices.len(), mesh.triangles), (3, vec![[0, 1, 2], [2, 1, 0]]));
    }

    #[test]
    fn the_chess_set_loads() {
        let model = load(&assets().join("chess.obj")).unwrap();
        check_sound(&model).unwrap();
        for name in ["pawn", "rook", "bishop", "queen", "king", "screen"] {
            assert_eq!(model.meshes.iter().filter(|mesh| mesh.name == name).count(), 1, "{name}");
        }
        assert!(model.meshes.iter().any(|mesh| mesh.name.starts_with("board")));
        let screen = model.meshes.iter().find(|mesh| mesh.name == "screen").unwrap();
        assert!(model.materials[screen.material].has_cutout());
        let (low, high) = model.meshes.iter().find(|mesh| mesh.name == "king").unwrap().bounds();
        assert!(low.y.abs() < 1e-3 && high.y > 1.0 && high.y < 3.0, "{low} {high}");
    }

    /// What a caller may rely on.
    fn check_sound(model: &Model) -> Result<(), TestCaseError> {
        prop_assert!(!model.meshes.is_empty());
        for mesh in &model.meshes {
            prop_assert!(!mesh.triangles.is_empty() && mesh.material < model.materials.len());
            let count = mesh.vertices.len() as u32;
            prop_assert!(mesh.triangles.as_flattened().iter().all(|&index| index < count));
            for vertex in &mesh.vertices {
                prop_assert!(vertex.position.is_finite() && vertex.uv.is_finite());
                prop_assert!((vertex.normal.length() - 1.0).abs() < 1e-6, "{vertex:?}");
            }
        }
        for material in &model.materials {
            for color in [material.base_color, material.specular, material.emission] {
                prop_assert!(color.is_finite() && color.min_element() >= 0.0);
            }
            prop_assert!((0.0..=1.0).contains(&material.opacity) && material.shininess >= 0.0);
            let mut textures =
                [material.base_texture, material.opacity_texture].into_iter().flatten();
            prop_assert!(textures.all(|index| index < model.textures.len()));
        }
        for texture in &model.textures {
            prop_assert_eq!(texture.rgba.len() as u32, texture.width * texture.height * 4);
        }
        Ok(())
    }

    const OBJ: &[u8] = b"mtllib m.mtl\no one\nusemtl red\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4\ng x\nusemtl cut\nf -1 -2//1 \\\n-3\n";
    const MTL: &[u8] = b"newmtl red\nKd 1 0 0\nNs 10\nd 0.5\nillum 2\nnewmtl cut\nmap_Kd t.png\n\
        map_d t.png\nKe 1\nTr 0.5\n";

    const STATEMENT: &str = "(v|vt|vn|f|o|g|l|#)( (-?[0-9]|1e38|3//1|2/1|x|\\\\\n)){0,5}";

    proptest! {
        #[test]
        fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            if let Ok(model) = load_files(&[("model.obj", &bytes)], &Limits::DEFAULT) {
                check_sound(&model)?;
            }
        }

        #[test]
        fn random_statements_never_panic(
            lines in prop::collection::vec(STATEMENT, 0..20),
        ) {
            if let Ok(model) = load_text(&format!("{TRIANGLE}{}\n", lines.join("\n"))) {
                check_sound(&model)?;
            }
        }

        #[test]
        fn random_mutations_never_panic(
            which in 0..3usize,
            flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
            cut in prop::option::of(any::<prop::sample::Index>()),
        ) {
            let png = crate::scene::texture::tests::png(&[[200, 100, 50, 128]; 4], 2);
            let mut files = [OBJ.to_vec(), MTL.to_vec(), png];
            let file = &mut files[which];
            for (place, byte) in &flips {
                let place = place.index(file.len());
                file[place] = *byte;
            }
            if let Some(cut) = &cut {
                file.truncate(cut.index(file.len()));
            }
            let [obj, mtl, png] = &files;
            let files: [(&str, &[u8]); 3] = [("model.obj", obj), ("m.mtl", mtl), ("t.png", png)];
            match load_files(&files, &Limits::DEFAULT) {
                Ok(model) => check_sound(&model)?,
                Err(_) => prop_assert!(cut.is_some() || !flips.is_empty()),
            }
        }
    }
}
