//! Models that load, and random files.

use super::*;
use crate::model::limits::Limits;
use crate::model::load::{Place, load_within};
use crate::scene::assets;
use proptest::prelude::*;
use std::path::MAIN_SEPARATOR;

pub const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Writes files into a folder of their own and reads `model.obj`. Errors and warnings are one line;
/// their paths are relative to the folder.
pub fn load_files(files: &[(&str, &[u8])], limits: &Limits) -> Result<Model, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let relative = |line: String| {
        let line = line.replace(&format!("{}{MAIN_SEPARATOR}", folder.path().display()), "");
        assert!(!line.contains('\n'), "{line}");
        line
    };
    let loaded = load_within(&folder.path().join("model.obj"), limits, Place::AsWritten);
    let mut model = loaded.map_err(|error| relative(format!("{error:#}")))?;
    model.warnings = model.warnings.into_iter().map(relative).collect();
    Ok(model)
}

/// The warnings for a model that loads.
#[track_caller]
pub fn warnings(files: &[(&str, &[u8])]) -> Vec<String> {
    load_files(files, &Limits::DEFAULT).unwrap().warnings
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
    assert_eq!(latin.meshes[0].name, "caf\u{10ffe9}");
}

#[test]
fn missing_normals_are_flat_and_given_ones_are_of_unit_length() {
    let mesh = only_mesh(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 3 4\nvn 0 0 0\nf 1 2 3\nf 1//1 3//2 4\n",
    );
    let normals: Vec<_> =
        mesh.triangles.as_flattened().iter().map(|&i| mesh.vertices[i as usize].normal).collect();
    assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::new(0.0, 0.6, 0.8), Vec3::X, Vec3::X]);
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

/// Checks the guarantees that callers rely on.
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
        let mut textures = [material.base_texture, material.opacity_texture].into_iter().flatten();
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
        let png = crate::model::texture::tests::png(&[[200, 100, 50, 128]; 4], 2);
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

#[test]
fn what_is_read_without_a_check_is_what_is_read_with_one() {
    let path = crate::scene::assets().join("chess.obj");
    assert_eq!(load_own(&path).unwrap(), load(&path).unwrap());
}

#[test]
fn the_notch_of_a_polygon_stays_open_from_every_first_corner() {
    let l = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    let area = |face: &str| {
        let mesh = only_mesh(&format!("{l}f {face}\n"));
        let area = |[a, b, c]: &[Vec3; 3]| 0.5 * (*b - *a).cross(*c - *a).z;
        positions(&mesh).iter().map(area).sum::<f32>()
    };
    assert_eq!(area("1 2 3 4 5 6"), 3.0);
    assert_eq!(area("2 3 4 5 6 1"), 3.0);
    assert_eq!(area("6 5 4 3 2 1"), -3.0);
    let by_hand = only_mesh(&format!("{l}f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\n"));
    assert_eq!(only_mesh(&format!("{l}f 1 2 3 4 5 6\n")), by_hand);
}

#[test]
fn smoothing_groups_are_smooth_and_others_have_edges() {
    // A roof of two squares: flat normals are (0, 0, 1) and (-1, 0, 0).
    let roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n";
    let faces = "f 1 2 3 4\nf 1 4 6 5\n";
    let normals = |obj: &str| {
        let mesh = only_mesh(obj);
        let vertex = |index: &u32| &mesh.vertices[*index as usize];
        let vertices = mesh.triangles.as_flattened().iter().map(vertex);
        vertices.map(|vertex| (vertex.position, vertex.normal)).collect::<Vec<_>>()
    };
    let flat = normals(&format!("{roof}{faces}"));
    assert!(flat.iter().all(|(_, normal)| *normal == Vec3::Z || *normal == Vec3::X));
    for off in ["s off\n", "s 0\n", "s\n"] {
        assert_eq!(normals(&format!("{roof}s 1\n{off}{faces}")), flat);
    }
    let half = Vec3::new(1.0, 0.0, 1.0).normalize();
    for on in ["s 1\n", "s on\n", "S 4294967295\n"] {
        for (position, normal) in normals(&format!("{roof}{on}{faces}")) {
            let right = match (position.x > 0.0, position.z > 0.0) {
                (true, _) => Vec3::Z,
                (_, true) => Vec3::X,
                _ => half,
            };
            assert!((normal - right).length() < 1e-6, "{position}: {normal}");
        }
    }
    // Another group, and the file's own normals, keep the edge.
    assert_eq!(normals(&format!("{roof}s 1\nf 1 2 3 4\ns 2\nf 1 4 6 5\n")), flat);
    let own = format!("{roof}vn 0 1 0\ns 1\nf 1//1 2//1 3//1\n");
    assert!(normals(&own).iter().all(|(_, normal)| *normal == Vec3::Y));
    let shared = only_mesh(&format!("{roof}s 1\n{faces}"));
    assert_eq!(shared.vertices.len(), 6);
    // A sheet whose two sides cancel out keeps its triangles' normals.
    assert!(
        normals("v 0 0 0\nv 1 0 0\nv 0 1 0\ns 1\nf 1 2 3\nf 3 2 1\n")
            .iter()
            .all(|(_, normal)| normal.z.abs() == 1.0)
    );
}

#[test]
fn faces_of_one_material_are_one_mesh_wherever_they_are() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib m.mtl\n";
    let mtl: (&str, &[u8]) = ("m.mtl", b"newmtl a\nnewmtl b\n");
    let load = |obj: &str| {
        let obj = format!("{vertices}{obj}");
        load_files(&[("model.obj", obj.as_bytes()), mtl], &Limits::DEFAULT).unwrap()
    };
    let mixed = load(&"usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n".repeat(3));
    let sorted =
        load(&format!("usemtl a\n{}usemtl b\n{}", "f 1 2 3\n".repeat(3), "f 3 2 1\n".repeat(3)));
    assert_eq!(mixed, sorted);
    assert_eq!(mixed.meshes.len(), 2);
    // Undefined materials are all the same grey; groups of one name are one group, objects are not.
    let model = load("usemtl x\nf 1 2 3\nusemtl y\nf 1 2 3\nf 1 2 3\n");
    assert_eq!((model.meshes.len(), model.meshes[0].triangles.len()), (1, 3));
    let model = load("g a\nf 1 2 3\ng b\nf 1 2 3\ng a\nf 1 2 3\n");
    let names: Vec<_> = model.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!((names, model.ambiguous.len()), (vec!["a", "b"], 0));
    let model = load("o a\nf 1 2 3\nusemtl a\nf 1 2 3\no b\nf 1 2 3\no a\nusemtl b\nf 1 2 3\n");
    let names: Vec<_> = model.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!((names, model.ambiguous), (vec!["a", "a", "b", "a"], vec!["a".to_owned()]));
}

#[test]
fn a_model_far_from_the_origin_is_moved_or_warned_of() {
    let near = "v 0.123 0.456 0\nv 0.823 0.456 0\nv 0.823 1.156 0.05\nf 1 2 3\n";
    let far = near
        .replace("v 0.", "v 388096.")
        .replace(" 0.456", " 3948996.456")
        .replace(" 1.", " 3948997.");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    std::fs::write(&path, &far).unwrap();
    let kept = load(&path).unwrap();
    assert!(
        kept.warnings[0].contains("model.obj: is 7.000e-1 from end to end and reaches 3.949e6"),
        "{:?}",
        kept.warnings
    );
    let scene = crate::scene::Scene::open(&path).unwrap();
    let [note] = &scene.model.warnings[..] else { panic!("{:?}", scene.model.warnings) };
    assert!(
        note.ends_with(
            "it was moved by (-388096.5, -3948996.8, 0.0) in 64 bits, and the camera with it; points that you \
             set, such as \"camera eye\", count from the new origin"
        ),
        "{note}"
    );
    let [moved, here] =
        [&scene.model, &load_text(near).unwrap()].map(|model| positions(&model.meshes[0]));
    for (moved, here) in moved.as_flattened().iter().zip(here.as_flattened()) {
        assert!((*moved + Vec3::new(0.5, 0.8, 0.0) - *here).length() < 1e-6, "{moved} {here}");
    }
    assert!(scene.camera.target.length() < 1.0, "{:?}", scene.camera);
}

#[test]
fn a_smoothing_group_is_smooth_where_positions_are_written_twice() {
    let soup = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 0 1 0\nv 0 0 1\n";
    let mesh = only_mesh(&format!("{soup}s 1\nf 1 2 3\nf 4 5 6\n"));
    let at_origin = mesh.vertices.iter().filter(|vertex| vertex.position == Vec3::ZERO);
    let normals: Vec<_> = at_origin.map(|vertex| vertex.normal).collect();
    assert_eq!(normals.len(), 2);
    assert!(
        normals
            .iter()
            .all(|normal| (*normal - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6)
    );
}

#[test]
fn a_face_that_crosses_itself_is_warned_of() {
    let model = load_text("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    let words = "model.obj:5: a face crosses itself; write triangles; some triangles stand for it (1 in all)";
    assert_eq!(model.warnings, [words]);
}
