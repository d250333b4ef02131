//! `SHADERS` names a folder with a fault: the line says where.

use std::fs;
use std::path::Path;

use crate::{refused_by, sample};

/// A copy of `shaders/` in which `edit` has changed one file of the sample.
fn folder(file: &str, edit: impl FnOnce(String) -> String) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    copy(&run::root().join("shaders"), folder.path());
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    let edited = edit(text.clone());
    assert_ne!(edited, text, "the edit of {file} has found nothing to change");
    fs::write(path, edited).unwrap();
    folder
}

fn copy(from: &Path, to: &Path) {
    for entry in from.read_dir().unwrap() {
        let from = entry.unwrap().path();
        let to = to.join(from.file_name().unwrap());
        if from.is_dir() {
            fs::create_dir(&to).unwrap();
            copy(&from, &to);
        } else {
            fs::copy(&from, &to).unwrap();
        }
    }
}

#[track_caller]
fn shaders_refused(folder: &Path, words: &[&str]) {
    let mut command = sample();
    command.env("SHADERS", folder);
    refused_by(command, 1, words);
}

fn appended(line: &str) -> impl FnOnce(String) -> String {
    move |text| format!("{text}{line}\n")
}

fn line_count(file: &str) -> usize {
    fs::read_to_string(run::root().join("shaders").join(file)).unwrap().lines().count()
}

#[test]
fn what_does_not_compile_has_file_and_line() {
    for file in ["02_basic/sky.rmiss", "02_basic/push.glsl", "common/false_color.glsl"] {
        let folder = folder(file, appended("vec3 unfinished( {"));
        let place = format!("shader does not compile: {file}:{}: ", line_count(file) + 1);
        shaders_refused(folder.path(), &[&place]);
    }
    let sky = "02_basic/sky.rmiss";
    for (text, words) in [
        ("", "shader does not compile: 02_basic/sky.rmiss: "),
        ("#version 460\n", "02_basic/sky.rmiss: Linking miss stage: Missing entry point"),
        ("#version 460\nvoid main() { discard; }\n", "02_basic/sky.rmiss:2: 'discard'"),
    ] {
        shaders_refused(folder(sky, |_| text.to_owned()).path(), &[words]);
    }
}

#[test]
fn includes_that_are_wrong() {
    let file = "02_basic/push.glsl";
    let place = format!("{file}:{}: #include ", line_count(file) + 1);
    for (name, words) in [
        ("gone.glsl", "cannot read the shader '"),
        ("../common/scene.glsl/../../../secret.glsl", "is not below"),
        ("/etc/passwd", "is not below"),
        ("", "it is not a file"),
    ] {
        let folder = folder(file, appended(&format!("#include \"{name}\"")));
        shaders_refused(folder.path(), &[&place, words]);
    }
}

#[test]
fn a_circle_of_includes_is_spliced_once() {
    let folder = folder("common/false_color.glsl", appended("#include \"02_basic/push.glsl\""));
    let status = sample().env("SHADERS", folder.path()).status().unwrap();
    assert!(status.success());
}

#[test]
fn shaders_that_are_missing() {
    let folder = folder("02_basic/sky.rmiss", appended(""));
    fs::remove_file(folder.path().join("02_basic/sky.rmiss")).unwrap();
    shaders_refused(folder.path(), &["cannot read the shader '", "sky.rmiss'"]);
    shaders_refused(Path::new("no such folder"), &["cannot read the shader 'no such folder/"]);
}

#[test]
fn structures_that_differ_name_the_field() {
    for (file, from, to, words) in [
        (
            "02_basic/push.glsl",
            "DirectionalLight light;",
            "DirectionalLight light; uint extra;",
            "Push.extra is in the shader but not in Rust",
        ),
        (
            "02_basic/push.glsl",
            "SceneAddresses scene;",
            "uint extra; SceneAddresses scene;",
            "Push.extra",
        ),
        (
            "02_basic/camera.glsl",
            "vec3 right;",
            "vec3 right; float pad;",
            "CameraBasis.pad is in the shader but not in Rust",
        ),
        (
            "02_basic/scene.glsl",
            "float shininess;",
            "float shininess; float extra;",
            "MaterialRecord.extra is in the shader but not in Rust",
        ),
        (
            "02_basic/scene.glsl",
            "uint illumination;",
            "uvec2 illumination;",
            "MaterialRecord takes 60 bytes in the shader, 56 in Rust",
        ),
        ("02_basic/scene.glsl", "uint mesh;", "", "InstanceRecord lacks mesh, which Rust has"),
    ] {
        let folder = folder(file, |text| text.replacen(from, to, 1));
        shaders_refused(folder.path(), &["02_basic/camera.rgen: ", words]);
    }
}
