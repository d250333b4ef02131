//! The glTF 2 files of Debian's assimp-testmodels, written to test another reader: each is shown as a small
//! reader of our own reads it, or refused in one line.

use std::fs;
use std::path::{Path, PathBuf};

use common::scene::Scene;
use glam::{Mat4, Quat, Vec3, Vec4};
use serde_json::Value;

use crate::sample;

/// The folder of the package.
const FOLDER: &str = "/usr/share/assimp/models/glTF2";

/// Files that cannot be shown, by the end of their path, and the reason.
const REFUSED: [(&str, &str); 23] = [
    ("techniqueWebGL/BoxTextured.gltf", ": requires the extension \"KHR_technique_webgl\""),
    ("BoxWithInfinites.glb", "it has no triangle whose indices and positions are right"),
    ("AllIndicesOutOfRange.gltf", "it has no triangle whose indices and positions are right"),
    ("MissingBin/BoxTextured.gltf", "buffer 0 names \"BoxTextured0.bin\", which is not there"),
    ("RecursiveNodes.gltf", " twice in the tree of nodes"),
    ("sceneWrongType.gltf", ": line 6: a value of another type than glTF 2 has here"),
    ("NoScene.gltf", ": has no nodes in its scene, and so nothing to show"),
    ("SceneWithoutNodes.gltf", ": has no nodes in its scene, and so nothing to show"),
    ("draco/2CylinderEngine.gltf", "its geometry is compressed; export it without compression"),
    ("PrimitiveMode_00.gltf", "has points, which are not shown"),
    ("PrimitiveMode_01.gltf", "has lines, which are not shown"),
    ("PrimitiveMode_02.gltf", "has lines, which are not shown"),
    ("PrimitiveMode_03.gltf", "has lines, which are not shown"),
    ("PrimitiveMode_07.gltf", "has points, which are not shown"),
    ("PrimitiveMode_08.gltf", "has lines, which are not shown"),
    ("PrimitiveMode_09.gltf", "has lines, which are not shown"),
    ("PrimitiveMode_10.gltf", "has lines, which are not shown"),
    ("badArray.gltf", ": line 44: a value of another type than glTF 2 has here"),
    ("badExtension.gltf", ": line 130: a value of another type than glTF 2 has here"),
    ("badNumber.gltf", ": line 132: a value of another type than glTF 2 has here"),
    ("badObject.gltf", ": line 125: a value of another type than glTF 2 has here"),
    ("badString.gltf", ": line 12: a value of another type than glTF 2 has here"),
    ("badUint.gltf", ": line 128: a value of another type than glTF 2 has here"),
];

/// Files whose vertices are not at the positions in their accessors: one has a skin, the other an index out
/// of range.
const MOVED: [&str; 2] = ["simple_skin.gltf", "IndexOutOfRange.gltf"];

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder can be read").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|end| end == "gltf" || end == "glb") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The JSON part of a file.
fn json(bytes: &[u8]) -> Value {
    if !bytes.starts_with(b"glTF") {
        return serde_json::from_slice(bytes).expect("JSON");
    }
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f32> {
    value
        .as_array()
        .map(|list| list.iter().map(|n| n.as_f64().unwrap() as f32).collect())
        .unwrap_or_default()
}

/// Adds the triangles of a node and its children, and their bounding box, from the bounds of their accessors.
fn add(root: &Value, node: usize, parent: Mat4, count: &mut usize, bounds: &mut [Vec3; 2]) {
    let node = &root["nodes"][node];
    let three = |key: &str, usual: f32| match &numbers(&node[key])[..] {
        &[x, y, z] => Vec3::new(x, y, z),
        _ => Vec3::splat(usual),
    };
    let rotation = match &numbers(&node["rotation"])[..] {
        &[x, y, z, w] => Quat::from_vec4(Vec4::new(x, y, z, w)).normalize(),
        _ => Quat::IDENTITY,
    };
    let local = match <[f32; 16]>::try_from(numbers(&node["matrix"])) {
        Ok(matrix) => Mat4::from_cols_array(&matrix),
        Err(_) => Mat4::from_scale_rotation_translation(
            three("scale", 1.0),
            rotation,
            three("translation", 0.0),
        ),
    };
    let place = parent * local;
    let mesh = node["mesh"].as_u64().map(|mesh| &root["meshes"][mesh as usize]);
    for primitive in mesh.iter().flat_map(|mesh| mesh["primitives"].as_array().unwrap()) {
        let accessor = |key: &Value| key.as_u64().map(|at| &root["accessors"][at as usize]);
        let positions = accessor(&primitive["attributes"]["POSITION"]).unwrap();
        let corners = accessor(&primitive["indices"]).unwrap_or(positions)["count"].as_u64();
        let corners = corners.unwrap() as usize;
        *count += match primitive["mode"].as_u64().unwrap_or(4) {
            4 => corners / 3,
            5 | 6 => corners - 2,
            _ => continue,
        };
        let (low, high) = (numbers(&positions["min"]), numbers(&positions["max"]));
        if low.is_empty() {
            // Without bounds, the file does not reveal its size.
            *bounds = [Vec3::NAN; 2];
            continue;
        }
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let at = place.transform_point3(Vec3::new(pick(0), pick(1), pick(2)));
            *bounds = [bounds[0].min(at), bounds[1].max(at)];
        }
    }
    for child in node["children"].as_array().into_iter().flatten() {
        add(root, child.as_u64().unwrap() as usize, place, count, bounds);
    }
}

#[test]
#[ignore = "nightly: a package of files; quick: models::a_gltf_file_is_shown_or_refused"]
fn gltf_files_of_another_reader_s_tests_are_shown_or_refused() {
    let folder = Path::new(FOLDER);
    if !folder.is_dir() {
        println!(
            "not tried: there is no {FOLDER}: run ./setup --tests, where the system has the package"
        );
        return;
    }
    let files = files(folder);
    assert!(files.len() >= 46, "{} files", files.len());
    for file in files {
        let name = file.to_str().unwrap();
        let mut command = sample();
        command.arg("--validate").arg("--scene").arg(&file);
        if let Some((_, why)) = REFUSED.iter().find(|(end, _)| name.ends_with(end)) {
            let (code, line) = run::refusal(command.output().unwrap());
            assert_eq!((code, line.contains(why)), (1, true), "{line}");
            continue;
        }
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{name}: {said}");
        assert!(said.lines().all(|line| line.starts_with("warning: ")), "{name}: {said}");
        if MOVED.iter().any(|end| name.ends_with(end)) {
            continue;
        }
        let scene = Scene::open(&file).unwrap();
        let root = json(&fs::read(&file).unwrap());
        let shown = root["scene"].as_u64().unwrap_or(0) as usize;
        let (mut count, mut bounds) = (0, [Vec3::INFINITY, Vec3::NEG_INFINITY]);
        for node in root["scenes"][shown]["nodes"].as_array().unwrap() {
            let node = node.as_u64().unwrap() as usize;
            add(&root, node, Mat4::IDENTITY, &mut count, &mut bounds);
        }
        let triangles =
            |instance: &common::scene::Instance| scene.model.meshes[instance.mesh].triangles.len();
        assert_eq!(scene.instances.iter().map(triangles).sum::<usize>(), count, "{name}");
        let (low, high) = scene.bounds();
        let size = (high - low).max_element();
        let apart = (low - bounds[0]).abs().max((high - bounds[1]).abs()).max_element();
        assert!(
            bounds[0].is_nan() || apart <= 1e-5 * size,
            "{name}: {low} to {high}, not {bounds:?}"
        );
    }
}
