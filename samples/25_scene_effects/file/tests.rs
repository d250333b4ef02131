//! Faults in a sky, in a surface of microfacets and in a normal map: each is one line.

use std::fs;

use super::open;

const CAMERA: &str = "[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfield_of_view = 40\n";
const MATERIAL: &str = "[[material]]\nname = \"a\"\n";

/// The error of a scene with these lines below its camera, or its warnings.
fn told(lines: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    fs::write(&file, format!("version = 1\n{CAMERA}{lines}")).unwrap();
    let line = match open(&file) {
        Ok(scene) => scene.scene.model.warnings.join("\n"),
        Err(error) => format!("{error:#}"),
    };
    line.replace(&format!("{}/", folder.path().display()), "")
}

#[track_caller]
fn check(lines: &str, expected: &str) {
    let told = told(lines);
    assert!(told.starts_with(expected), "{told:?}");
    assert_eq!(told.lines().count(), 1, "{told:?}");
}

#[test]
fn a_sky_is_one_picture() {
    let what = "s.toml:6: a sky has a `file`, such as \"sky.exr\", or the `name` of one of chapter 46: \"day\" or \
                \"evening\"";
    for keys in ["", "name = \"noon\"\n", "name = \"day\"\nfile = \"day.exr\"\n", "rotation = 30\n"]
    {
        check(&format!("[sky]\n{keys}"), what);
    }
    let sky = |keys: &str| format!("[sky]\nname = \"day\"\n{keys}\n");
    check(&sky("rotation = 400"), "s.toml:6: 400.0 is not a number from -360 to 360");
    check(&sky("brightness = -1"), "s.toml:6: -1.0 is not a number from 0 to ");
    check(
        &sky("bright = 1"),
        "s.toml:6: there is no key `bright` here; there is file, name, rotation",
    );
    check("[sky]\nname = 3\n", "s.toml:6: write a text in quotes here");
    check("[sky]\nfile = \"gone.exr\"\n", "s.toml:6: ");
    check("[[sky]]\nname = \"day\"\n", "s.toml:6: there is one sky; write it as [sky]");
    assert_eq!(told(&sky("rotation = -90\nbrightness = 0.5")), "");
}

#[test]
fn a_picture_of_the_sky_is_in_the_files_folder() {
    let sky = |file: &str| told(&format!("[sky]\nfile = \"{file}\"\n"));
    for file in ["gone.exr", "../gone.exr", "/gone.exr", "C:\\\\gone.exr", "", "."] {
        let told = sky(file);
        assert!(told.starts_with("s.toml:6: ") && told.lines().count() == 1, "{file}: {told:?}");
        assert!(!told.contains("OBJ"), "{told:?}");
    }
}

#[test]
fn a_surface_is_of_one_kind() {
    let rough =
        "s.toml:6: a mirror and glass have no `roughness` and no `metallic`; take one of them out";
    for keys in ["roughness = 0.5\nmirror = true\n", "metallic = 1\nglass = \"thick\"\n"] {
        check(&format!("{MATERIAL}{keys}"), rough);
    }
    check(&format!("{MATERIAL}roughness = 2\n"), "s.toml:8: 2.0 is not a number from 0 to 1");
    check(
        &format!("{MATERIAL}metallic = \"yes\"\n"),
        "s.toml:8: \"yes\" is not a number from 0 to 1",
    );
    check(&format!("{MATERIAL}blended = 1\n"), "s.toml:8: write true or false here");
    assert_eq!(told(&format!("{MATERIAL}roughness = 0.5\nmirror = false\n")), "");
}

#[test]
fn a_normal_map_is_on_a_mesh() {
    let bumpy = format!("{MATERIAL}normal_map = \"hammered\"\n");
    assert_eq!(told(&format!("{bumpy}normal_scale = 2\n")), "");
    let which = "is no normal map; write \"bevelled\" or \"hammered\"";
    check(&format!("{MATERIAL}normal_map = \"a.png\"\n"), &format!("s.toml:8: \"a.png\" {which}"));
    check(
        &format!("{MATERIAL}normal_scale = 2\n"),
        "s.toml:6: `normal_scale` is of a `normal_map`",
    );
    check(&format!("{bumpy}normal_scale = -1\n"), "s.toml:9: -1.0 is not a number from 0 to 20");
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";
    check(
        &format!("{bumpy}{ball}"),
        "s.toml:12: \"a\" has holes, a texture or lines, which only meshes can have",
    );
}
