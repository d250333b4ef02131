//! The device's own implementation, on a simulated device: the layer in
//! `tests/samples/opacity_micromaps/layer` adds the extension, checks each structure against the rules, and
//! reports the builds.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::app::Picture;
use common::model::Texture;
use common::scene::{Mesh, Scene};
use run::layer::Layer;
use run::{Chapter, refused, render, root, same_answers, same_colors, set_arguments};

use super::alpha::Alpha;
use super::classify::{self, Rule};
use super::{BEFORE, BEHIND, NAME, PARENT, SIZE, curve};

/// The layer's messages about a run, and the run's output.
struct Told {
    picture: Picture,
    /// Lines by their first word.
    lines: BTreeMap<String, Vec<String>>,
    errors: String,
}

impl Told {
    fn of(&self, word: &str) -> &[String] {
        self.lines.get(word).map_or(&[], Vec::as_slice)
    }

    /// The level and states of each micromap, in the order of the builds.
    fn micromaps(&self) -> Vec<(u32, Vec<u8>)> {
        let read = |line: &String| {
            let (level, states) = line.split_once(' ').unwrap();
            let byte = |at| u8::from_str_radix(&states[at..at + 2], 16).unwrap();
            (level.parse().unwrap(), (0..states.len()).step_by(2).map(byte).collect())
        };
        self.of("micromap").iter().map(read).collect()
    }
}

/// Returns whether the layer can read a device's memory: on the software driver, whose addresses are the
/// host's.
fn has_layer() -> bool {
    run::device::is_software()
}

/// A run with micromaps up to level `finest`.
fn told(finest: u32, arguments: &[&str]) -> Told {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = ["told", "out.exr"].map(|name| folder.path().join(name));
    // The validation layer of Debian 12 knows none of the structures, so it is disabled.
    let output = Layer::micromaps(&format!("level={finest},tell={}", file.display()))
        .command(NAME)
        .args(["--headless", "--size", SIZE, "--out", out.to_str().unwrap()])
        .args(arguments)
        .output()
        .expect("the sample starts");
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    let mut lines: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for line in fs::read_to_string(&file).unwrap().lines() {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        lines.entry(word.to_owned()).or_default().push(rest.to_owned());
    }
    let told = Told { picture: Picture::open_exr(&out).unwrap(), lines, errors };
    assert_eq!(told.of("broken"), [""; 0], "{arguments:?}");
    assert_eq!(told.of("alive"), ["0"], "{arguments:?}");
    told
}

/// The packed states of a mesh.
fn packed(mesh: &Mesh, texture: &Texture, level: u32, rule: Rule) -> Vec<u8> {
    let alpha = Alpha::new(texture.width, texture.height, &texture.rgba);
    let of = |corners: &[u32; 3]| {
        let corners = corners.map(|corner| mesh.vertices[corner as usize].uv);
        curve::pack(&classify::triangle(&alpha, corners, level, rule))
    };
    mesh.triangles.iter().flat_map(of).collect()
}

/// Compares the micromap indices of a bottom level with its mesh: each primitive has the states of its own
/// triangle. Returns the number of primitives.
fn names_its_own(line: &str, mesh: &Mesh) -> usize {
    let (corners, indices) = line.split_once(' ').unwrap();
    let numbers =
        |text: &str| -> Vec<u32> { text.split(',').map(|n| n.parse().unwrap()).collect() };
    let (corners, indices) = (numbers(corners), numbers(indices));
    assert_eq!(corners.len(), 3 * indices.len());
    for (primitive, &index) in corners.chunks(3).zip(&indices) {
        assert_eq!(primitive, mesh.triangles[index as usize]);
    }
    indices.len()
}

/// The mesh of the screen, and its texture.
fn screen(scene: &Scene) -> (&Mesh, &Texture) {
    let mesh = scene.model.meshes.iter().find(|mesh| mesh.name == "screen").unwrap();
    let texture = scene.model.materials[mesh.material].opacity_texture.unwrap();
    (mesh, &scene.model.textures[texture])
}

#[test]
fn a_device_gets_the_states_that_the_shader_reads() {
    if !has_layer() {
        return;
    }
    let scene = Scene::chess().unwrap();
    let (mesh, texture) = screen(&scene);
    let parent = Chapter::new(PARENT).size(SIZE).sets(&BEHIND).picture();
    for (level, rule, word) in [
        (0, Rule::Conservative, "conservative"),
        (3, Rule::Conservative, "conservative"),
        (5, Rule::Samples, "samples"),
        (6, Rule::Conservative, "conservative"),
    ] {
        let sets = [format!("level={level}"), format!("rule={word}"), "way=device".to_owned()];
        let sets = sets.each_ref().map(String::as_str);
        let told = told(6, &set_arguments(&sets));
        assert_eq!(told.errors, "");
        assert!(told.micromaps() == [(level, packed(mesh, texture, level, rule))], "{level}");
        let [named] = told.of("level") else { panic!("one bottom level has a micromap") };
        assert_eq!(names_its_own(named, mesh), mesh.triangles.len());
        assert_eq!(told.of("pipeline").len(), 1);
        // The layer's device calls the any-hit shader for each candidate, which then reads the texture.
        same_colors(word, NAME, &told.picture, &parent);
    }
}

#[test]
fn a_level_that_is_too_fine_for_the_device_falls_back_to_its_finest_and_says_so() {
    if !has_layer() {
        return;
    }
    let scene = Scene::chess().unwrap();
    let (mesh, texture) = screen(&scene);
    let told = told(3, &set_arguments(&["way=device", "show=hit"]));
    assert!(told.micromaps() == [(3, packed(mesh, texture, 3, Rule::Conservative))]);
    let line = told.errors.trim_end();
    assert!(line.starts_with("warning: llvmpipe"), "{line}");
    assert!(line.ends_with("takes micromaps up to level 3: it gets those, not 5"), "{line}");
    let hits = Chapter::new(PARENT).size(SIZE).sets(&["show=hit"]).sets(&BEHIND).picture();
    same_answers("hits", NAME, &told.picture, &hits);
}

#[test]
fn without_the_extension_the_device_s_way_is_refused_in_one_line() {
    if !has_layer() {
        return;
    }
    let (code, line) = refused(NAME, &["--headless", "--size", "8x8", "--set", "way=device"]);
    assert_eq!(code, 1);
    let words =
        "has no VK_KHR_opacity_micromap: use way=shader, where the any-hit shader reads the states";
    assert!(line.contains(words), "{line}");
}

#[test]
fn where_it_is_not_asked_for_nothing_is_built_for_the_device() {
    if !has_layer() {
        return;
    }
    let sets = ["show=states", "level=4"];
    let shader = told(6, &set_arguments(&sets));
    assert_eq!(shader.lines.keys().collect::<Vec<_>>(), ["alive"]);
    let none = told(6, &set_arguments(&["level=none", "way=device"]));
    assert_eq!(none.lines.keys().collect::<Vec<_>>(), ["alive"]);
    // The scene's own bottom levels show the states: a device skips transparent parts.
    let device = told(6, &set_arguments(&[&sets[..], &["way=device"]].concat()));
    assert_eq!(device.of("pipeline"), [""; 0]);
    same_colors("states", NAME, &device.picture, &shader.picture);
}

/// Two meshes with holes and one without; with five triangles, whose states at level 0 fill no whole word.
fn three_meshes(folder: &Path) -> String {
    let mut obj = String::from("mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.3 0.7\n");
    for (material, first) in [("a", 0), ("plain", 5), ("b", 10)] {
        obj += &format!("o {material}\nusemtl {material}\n");
        for i in first..first + 5 {
            let (x, z) = (i % 5, i / 5);
            obj += &format!("v {x} 0 {z}\nv {x}.9 0 {z}\nv {x} 0 {z}.9\n");
            obj += &format!("f -3/{} -2/2 -1/3\n", 1 + 3 * (i % 2));
        }
    }
    fs::write(folder.join("m.obj"), obj).unwrap();
    let mtl = "newmtl a\nmap_d fretwork.png\nnewmtl plain\nKd 1 0 0\nnewmtl b\nmap_d hole.png\n";
    fs::write(folder.join("m.mtl"), mtl).unwrap();
    fs::copy(root().join("samples/assets/fretwork.png"), folder.join("fretwork.png")).unwrap();
    let hole = |x, y| image::Rgba([255, 255, 255, if x < 8 && y < 8 { 0 } else { 255 }]);
    image::RgbaImage::from_fn(16, 16, hole).save(folder.join("hole.png")).unwrap();
    folder.join("m.obj").to_str().unwrap().to_owned()
}

#[test]
fn each_mesh_with_holes_has_a_micromap_of_its_own() {
    if !has_layer() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = three_meshes(folder.path());
    let scene = Scene::open(file.as_ref()).unwrap();
    for level in [0, 1, 4] {
        let set = format!("level={level}");
        let arguments = set_arguments(&["way=device", &set]);
        let told = told(6, &[&arguments[..], &["--scene", &file]].concat());
        let with_holes = scene.model.meshes.iter().filter_map(|mesh| {
            let texture = scene.model.materials[mesh.material].opacity_texture?;
            let states = packed(mesh, &scene.model.textures[texture], level, Rule::Conservative);
            Some((mesh, (level, states)))
        });
        let (meshes, expected): (Vec<_>, Vec<_>) = with_holes.unzip();
        assert_eq!(meshes.len(), 2);
        assert!(told.micromaps() == expected, "{level}");
        for (line, mesh) in told.of("level").iter().zip(meshes) {
            assert_eq!(names_its_own(line, mesh), 5);
        }
        let parent = render(PARENT, SIZE, &["--scene", &file]).picture;
        same_colors(&set, NAME, &told.picture, &parent);
    }
}

/// The worst driver has each triangle twice, and so do the bottom levels with micromaps.
#[test]
fn a_triangle_that_is_offered_twice_has_its_states_twice() {
    if !has_layer() || !run::has_worst_arithmetic() {
        return;
    }
    let scene = Scene::chess().unwrap();
    let (mesh, _) = screen(&scene);
    let sets = [&["way=device"], &BEFORE[..]].concat();
    let told = told(5, &[&set_arguments(&sets)[..], &["--arithmetic", "worst"]].concat());
    assert_eq!(names_its_own(&told.of("level")[0], mesh), 2 * mesh.triangles.len());
}
