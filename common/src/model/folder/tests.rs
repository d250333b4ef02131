//! Files that a model names: where they are looked for, and what is said if they are elsewhere.

use super::super::obj::tests::{TRIANGLE, load_files};
use super::super::texture::tests::png;
use crate::model::limits::Limits;

/// A triangle with texture coordinates.
const TEXTURED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";

/// The name of the texture found and the warnings, for a model whose MTL file `mtl` names `map`; the files are
/// textures.
fn found(mtl: &str, map: &str, files: &[&str]) -> (Option<String>, Vec<String>) {
    let obj = format!("mtllib {mtl}\nusemtl a\n{TEXTURED}");
    let text = format!("newmtl a\nmap_Kd {map}\n");
    let texel = png(&[[1, 2, 3, 4]], 1);
    let mut all = vec![("model.obj", obj.as_bytes()), (mtl, text.as_bytes())];
    all.extend(files.iter().map(|&name| (name, &texel[..])));
    let model = load_files(&all, &Limits::DEFAULT).unwrap();
    (model.textures.first().map(|texture| texture.name.clone()), model.warnings)
}

#[track_caller]
fn silent(mtl: &str, map: &str, file: &str) {
    assert_eq!(found(mtl, map, &[file]), (Some(file.to_owned()), vec![]));
}

#[test]
fn a_path_is_judged_by_where_it_leads() {
    silent("mats/m.mtl", "../textures/t.png", "textures/t.png");
    silent("m.mtl", "./sub/../sub/t.png", "sub/t.png");
    // No such folder, as on Windows.
    silent("m.mtl", "gone/../t.png", "t.png");
    silent("a/b/c/m.mtl", "..\\..\\..\\t.png", "t.png");
    // Next to the OBJ file, although the MTL file is in another folder.
    silent("mats/m.mtl", "t.png", "t.png");
    silent("mats/m.mtl", "textures/t.png", "textures/t.png");
    // The MTL file's own comes first.
    let both = found("mats/m.mtl", "t.png", &["t.png", "mats/t.png"]);
    assert_eq!(both, (Some("mats/t.png".to_owned()), vec![]));
    silent("m.mtl", "\"my t.png\"", "my t.png");
    silent("m.mtl", "t.png # a comment", "t.png");
    silent("m.mtl", "tile #2.png", "tile #2.png");
}

#[test]
fn a_file_of_that_name_beside_the_model_is_taken() {
    let outside = "outside the OBJ file's folder";
    let gone = "which is not there";
    for (map, file, why) in [
        ("C:\\Users\\somebody\\Desktop\\tex\\wood.png", "wood.png", outside),
        ("/home/somebody/tex/wood.png", "wood.png", outside),
        ("\\\\server\\tex\\wood.png", "wood.png", outside),
        ("../../wood.png", "wood.png", outside),
        ("C:\\models\\tex\\wood.png", "tex/wood.png", outside),
        ("tex/wood.png", "wood.png", gone),
    ] {
        let (name, warnings) = found("m.mtl", map, &[file]);
        assert_eq!(name.as_deref(), Some(file), "{map}");
        let line = format!(
            "m.mtl:2: map_Kd names {map:?}, {why}; write {file:?}; the file of that name beside the model is \
             taken (1 in all)"
        );
        assert_eq!(warnings, [line]);
    }
    let obj = format!("mtllib /home/somebody/My models/m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 2] =
        [("model.obj", obj.as_bytes()), ("m.mtl", b"newmtl a\nKd 1 0 0\n")];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    assert_eq!(model.materials[0].base_color, glam::Vec3::X);
    assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_differs_only_in_case_is_named() {
    for (mtl, map, file, right) in [
        ("m.mtl", "Wood.PNG", "wood.png", "wood.png"),
        ("m.mtl", "textures\\Wood.png", "Textures/wood.PNG", "Textures/wood.PNG"),
        ("mats/m.mtl", "WOOD.png", "mats/wood.png", "wood.png"),
        ("m.mtl", "É.png", "é.png", "é.png"),
    ] {
        let (name, warnings) = found(mtl, map, &[file]);
        assert_eq!(name, None);
        let words = format!(
            "map_Kd names {map:?}, which is not there; {right:?} differs only in case: write that; the plain \
             colour stands for it (1 in all)"
        );
        assert!(warnings[0].ends_with(&words), "{warnings:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_link_out_of_the_folder_is_named_as_such_and_a_folder_also() {
    let [folder, elsewhere] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let at = |name: &str| folder.path().join(name);
    let outside = elsewhere.path().join("t.png");
    std::fs::write(&outside, png(&[[1, 2, 3, 4]], 1)).unwrap();
    std::os::unix::fs::symlink(&outside, at("link.png")).unwrap();
    std::fs::create_dir(at("dir.png")).unwrap();
    std::fs::write(at("model.obj"), format!("mtllib m.mtl\nusemtl a\n{TEXTURED}")).unwrap();
    for (name, why) in [
        ("link.png", "outside the OBJ file's folder; copy it into the folder"),
        ("dir.png", "which is a folder"),
    ] {
        std::fs::write(at("m.mtl"), format!("newmtl a\nmap_Kd {name}\n")).unwrap();
        let warnings = super::super::obj::load(&at("model.obj")).unwrap().warnings;
        let words =
            format!("map_Kd names \"{name}\", {why}; the plain colour stands for it (1 in all)");
        assert!(warnings.len() == 1 && warnings[0].ends_with(&words), "{warnings:?}");
    }
}

#[test]
fn names_of_another_encoding_are_not_confused() {
    let (red, blue): (&[u8], &[u8]) = (b"\x90\xd4", b"\x90\xc2");
    // The second byte of this one is that of a backslash.
    let table: &[u8] = b"\x95\x5c";
    let names = [red, blue, table];
    let mut obj = b"mtllib m.mtl\n".to_vec();
    let mut mtl = Vec::new();
    for (number, name) in names.iter().enumerate() {
        obj.extend([b"usemtl ", *name, b"\n", TRIANGLE.as_bytes()].concat());
        mtl.extend([b"newmtl ", *name, format!("\nKd 0 0 0.{number}\n").as_bytes()].concat());
    }
    let model = load_files(&[("model.obj", &obj), ("m.mtl", &mtl)], &Limits::DEFAULT).unwrap();
    assert_eq!((model.warnings.len(), model.materials.len()), (0, 3), "{:?}", model.warnings);
    let colors: Vec<_> =
        model.meshes.iter().map(|mesh| model.materials[mesh.material].base_color.z).collect();
    assert_eq!(colors, [0.0, 0.1, 0.2]);

    obj.extend(b"usemtl caf\xe9\nf 1 2 3\n");
    let model = load_files(&[("model.obj", &obj), ("m.mtl", &mtl)], &Limits::DEFAULT).unwrap();
    let words =
        r#"the material "caf\xE9" is not defined; the mtllib files hold "\x90\xD4", "\x90\xC2""#;
    assert!(model.warnings[0].contains(words), "{:?}", model.warnings);
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_whose_name_is_of_another_encoding_is_found_and_shown() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &[u8]| folder.path().join(std::ffi::OsStr::from_bytes(name));
    std::fs::write(at(b"model.obj"), format!("mtllib m.mtl\nusemtl a\n{TEXTURED}")).unwrap();
    std::fs::write(at(b"m.mtl"), b"newmtl a\nmap_Kd caf\xe9.png\n").unwrap();
    std::fs::write(at(b"caf\xe9.png"), png(&[[1, 2, 3, 4]], 1)).unwrap();
    let load = || super::super::obj::load(&at(b"model.obj")).unwrap();
    assert_eq!((load().textures.len(), load().warnings.len()), (1, 0));
    std::fs::write(at(b"caf\xe9.png"), "text").unwrap();
    assert!(load().warnings[0].contains(r"the texture "), "{:?}", load().warnings);
    assert!(load().warnings[0].contains(r"caf\xE9.png: is neither a PNG"), "{:?}", load().warnings);
    std::fs::rename(at(b"caf\xe9.png"), at("café.png".as_bytes())).unwrap();
    let words = r#"map_Kd names "caf\xE9.png", which is not there; its name is not UTF-8 here"#;
    assert!(load().warnings[0].contains(words), "{:?}", load().warnings);
}

#[test]
fn a_comment_after_a_name_is_no_part_of_it() {
    let obj = format!(
        "mtllib h.mtl # the library\no thing # one\nusemtl a # red\n{TRIANGLE}usemtl b\t#blue\nf 1 2 3\nusemtl Material #25\nf 1 2 3\n\
         usemtl #ff8000\nf 1 2 3\nusemtl a # \nf 1 2 3\n"
    );
    let mtl: &[u8] =
        b"newmtl a # first\nKd 1 0 0 # r\nnewmtl b\nnewmtl Material #25\nnewmtl Material #26\n\
        newmtl #ff8000\n";
    let files = [("model.obj", obj.as_bytes()), ("h.mtl", mtl)];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    assert_eq!(model.warnings, [""; 0]);
    let names: Vec<_> = model.materials.iter().map(|material| &material.name[..]).collect();
    assert_eq!(names, ["a", "b", "Material #25", "Material #26", "#ff8000"]);
    assert_eq!(model.meshes[0].name, "thing");
}

#[test]
fn text_of_another_encoding_is_named() {
    let wide = |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_le_bytes).collect() };
    let error = load_files(&[("model.obj", &wide(TRIANGLE))], &Limits::DEFAULT).unwrap_err();
    assert_eq!(error, "model.obj:1: this is UTF-16 text; save it as UTF-8");
    // Without its materials, a model is shown.
    let obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let files = [("model.obj", obj.as_bytes()), ("m.mtl", &wide("newmtl a\n"))];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    let line =
        "m.mtl:1: this is UTF-16 text; save it as UTF-8; its materials are not known (1 in all)";
    assert_eq!(model.warnings, [line]);
    let marked = [b"\xef\xbb\xbf", TRIANGLE.as_bytes()].concat();
    assert!(load_files(&[("model.obj", &marked)], &Limits::DEFAULT).is_ok());
}
