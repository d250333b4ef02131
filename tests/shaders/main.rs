//! All shaders of the samples: each compiles, is used, and declares its structures like Rust.

mod audit;
mod extensions;
mod promises;

use std::collections::BTreeSet;
use std::path::Path;

use common::gpu::shader::{Shader, compile};
use common::gpu::{Known, Reflection, Scalar, StructLayout};
use common::scene::{CameraBasis, DirectionalLight, SceneAddresses};

common::shader_struct! {
    /// The structures shared by every chapter from 02 on with its shaders.
    struct Shared { scene: SceneAddresses, camera: CameraBasis, sun: DirectionalLight }
}

/// The extension of files that are only included; all others are stages.
const INCLUDED: &str = "glsl";

/// Every file below `shaders/`, with `/` between the parts of its path.
fn files() -> BTreeSet<String> {
    fn walk(folder: &Path, below: &str, found: &mut BTreeSet<String>) {
        for entry in folder.read_dir().expect("shaders/ can be read") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy();
            let below = format!("{below}{name}");
            if path.is_dir() {
                walk(&path, &format!("{below}/"), found);
            } else {
                found.insert(below);
            }
        }
    }
    let mut found = BTreeSet::new();
    walk(&run::root().join("shaders"), "", &mut found);
    found
}

/// Every stage, compiled.
fn stages() -> Vec<Shader> {
    let stages = files().into_iter().filter(|file| !file.ends_with(INCLUDED));
    stages.map(|stage| compile(&stage).unwrap_or_else(|error| panic!("{error:#}"))).collect()
}

#[test]
fn every_stage_compiles() {
    let stages = stages();
    assert!(stages.iter().any(|stage| stage.path == "common/gather.comp"));
    assert!(stages.len() >= 7, "{} stages", stages.len());
    for stage in stages {
        assert_eq!(stage.spirv[0], 0x0723_0203, "{}", stage.path);
        assert_eq!(stage.files()[0], stage.path);
    }
}

#[test]
fn structures_are_the_same_in_rust_and_in_every_shader() {
    let mut seen = BTreeSet::new();
    let known = Known::of::<Shared>();
    for stage in stages() {
        let reflection = Reflection::of(&stage.spirv).unwrap();
        reflection.check(&stage.path, known.structs()).unwrap();
        seen.extend(reflection.structs().into_iter().map(|(name, _)| name));
    }
    for layout in known.structs().iter().filter(|layout| layout.name != "Shared") {
        assert!(
            seen.contains(layout.name),
            "no shader has {}, so nothing was checked",
            layout.name
        );
    }
}

#[test]
fn a_structure_that_differs_is_refused_by_name() {
    let stage = compile("02_basic/shade.rchit").unwrap();
    let reflection = Reflection::of(&stage.spirv).unwrap();
    let layout = |fields: &'static [(&'static str, usize, Option<Scalar>)], size| StructLayout {
        name: "Vertex",
        fields,
        size,
    };
    const FLOAT: Option<Scalar> = Some(Scalar::Float);
    const UINT: Option<Scalar> = Some(Scalar::Uint);
    const POSITION: (&str, usize, Option<Scalar>) = ("position", 0, FLOAT);
    let right = layout(&[POSITION, ("normal", 12, FLOAT), ("uv", 24, FLOAT)], 32);
    reflection.check("a.rchit", &[right]).unwrap();
    for (wrong, words) in [
        (
            layout(&[POSITION, ("normal", 16, FLOAT), ("uv", 24, FLOAT)], 32),
            "Vertex.normal is 12 bytes",
        ),
        (
            layout(&[POSITION, ("normal", 12, UINT), ("uv", 24, FLOAT)], 32),
            "Vertex.normal is made of float in the shader, and of u32 in Rust",
        ),
        (layout(&[POSITION, ("uv", 24, FLOAT)], 32), "Vertex.normal is in the shader but not in"),
        (
            layout(&[POSITION, ("normal", 12, FLOAT), ("uv", 24, FLOAT), ("id", 32, UINT)], 32),
            "Vertex lacks id, which Rust has",
        ),
        (layout(right.fields, 48), "Vertex takes 32 bytes in the shader, 48 in Rust"),
    ] {
        let error = reflection.check("a.rchit", &[wrong]).unwrap_err().to_string();
        assert!(error.starts_with("a.rchit: ") && error.contains(words), "{error}");
    }
}

#[test]
fn a_structure_at_an_address_that_rust_does_not_know_is_refused_by_name() {
    let stage = compile("02_basic/shade.rchit").unwrap();
    let reflection = Reflection::of(&stage.spirv).unwrap();
    let known = Known::of::<SceneAddresses>();
    reflection.check_addresses("a.rchit", known.structs()).unwrap();
    let names: Vec<_> = known.structs().iter().map(|layout| layout.name).collect();
    assert_eq!(names, ["SceneAddresses", "InstanceRecord", "Vertex", "MaterialRecord"]);
    for missing in ["InstanceRecord", "Vertex", "MaterialRecord"] {
        let rest: Vec<_> =
            known.structs().iter().filter(|layout| layout.name != missing).copied().collect();
        let error = reflection.check_addresses("a.rchit", &rest).unwrap_err().to_string();
        let words = format!("a.rchit: the shader reads a {missing} through an address");
        assert!(error.starts_with(&words), "{error}");
        assert!(error.ends_with(&format!("Address<{missing}>")), "{error}");
    }
}

#[test]
fn every_file_is_used_by_a_chapter() {
    let mut used = BTreeSet::new();
    let plain = run::chapters().into_iter().map(|chapter| (chapter, vec![]));
    // Their pictures use one of their many pipelines.
    let gathered = ("04_jitter_camera".to_owned(), vec!["--samples", "0..1"]);
    let best = ("24_accuracy".to_owned(), vec!["--set", "rung=64 bits"]);
    let recursive = ("06_reflection".to_owned(), vec!["--set", "method=recursive"]);
    let groups = ("13_callable_shader".to_owned(), vec!["--set", "choose by=hit group"]);
    for (chapter, arguments) in plain.chain([gathered, best, recursive, groups]) {
        let output = run::command(&chapter)
            .args(["--headless", "--size", "8x8", "--report", "-"])
            .args(arguments)
            .output()
            .expect("the sample starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        let report: serde_json::Value = serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|error| panic!("{chapter}: {error}: {errors}"));
        let stages = report["stages"].as_array().expect("the report lists stages");
        assert!(!stages.is_empty(), "{chapter} reports no stages");
        for stage in stages {
            used.extend(compile(stage.as_str().expect("a path")).unwrap().files());
        }
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = run::command("24_accuracy")
        .args(["--headless", "--only", "sphere", "--only", "triangle", "--rays", "8"])
        .args(["--rounds", "0", "--measure"])
        .arg(folder.path())
        .output()
        .expect("the sample starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.path().join("accuracy.json")).expect("it is there");
    let measured: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for stage in measured["stages"].as_array().expect("stages are listed") {
        used.extend(compile(stage.as_str().expect("a path")).unwrap().files());
    }
    // The atlas and the search for faults do not list their stages: their sources name them, and their own tests run
    // them all.
    for (source, start) in [("atlas/tracer.rs", "atlas"), ("faults.rs", "faults")] {
        let source = run::root().join("samples/24_accuracy").join(source);
        let source = std::fs::read_to_string(source).expect("a source");
        let is_stage = |word: &&str| word.starts_with(start) && word.contains(".r");
        for stage in source.split('"').filter(is_stage) {
            used.extend(compile(&format!("24_accuracy/{stage}")).unwrap().files());
        }
    }
    // The same holds for trees built on the device, and for the shaders used by their tests.
    for source in ["on_device.rs", "on_gpu.rs"] {
        let source = run::root().join("samples/30_own_tree").join(source);
        let source = std::fs::read_to_string(source).expect("a source");
        let is_shader = |word: &&str| word.ends_with(".comp") || word.starts_with("rays.");
        for stage in source.split('"').filter(is_shader) {
            used.extend(compile(&format!("30_own_tree/{stage}")).unwrap().files());
        }
    }
    // A window develops its picture by this one; its own test compares that with a PNG.
    used.extend(compile("common/develop.comp").unwrap().files());
    let orphans: Vec<_> = files().difference(&used).cloned().collect();
    assert!(orphans.is_empty(), "used by no chapter: {}", orphans.join(", "));
}
