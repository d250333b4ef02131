//! OBJ files: faults that are refused, and those that cause only a warning.

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
    let bytes = load_files(&[("model.obj", b"\xff\x80\xfe\n")], &Limits::DEFAULT);
    assert!(bytes.unwrap_err().starts_with(r#"model.obj:1: "\xFF\x80\xFE" is not a"#));
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
    line_refused("f 1 2 0", "face index 0 is out of range: indices start at 1, or at -1 backwards");
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

/// After four positions, one normal and one texture coordinate, lines from 7 on cause warnings.
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
    let hint = "is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl and mtllib are";
    let warning = format!("model.obj:7: \"group\" {hint}; the line is ignored (2 in all)");
    lines_warned("group a b\ncurve 1 2\nF 1 2", &[&warning.replace("2 in", "3 in")]);
    lines_warned("group\nxyz", &[&warning]);
    let known = "l 1 2\np 1\ns off\nvp 0.5\ncstype bezier\ndeg 3\ncurv 0 1 1 2\nend\nlod 2\n\
                 bevel on\nshadow_obj a.obj\nmg 1 0.5";
    lines_warned(known, &[]);
}

#[test]
fn what_takes_too_much_memory_is_refused_with_all_that_it_would_take() {
    // A triangle needs 620 bytes, and a corner is written in two.
    let limits = Limits { memory: 4_000_000, ..Limits::DEFAULT };
    let polygon = |corners: usize| format!("v 0 0 0\nf{}\n", " 1".repeat(corners));
    let load = |text: &str| load_files(&[("model.obj", text.as_bytes())], &limits);
    load(&polygon(1000).repeat(5)).unwrap();
    let refused = load(&polygon(1000).repeat(10_000)).unwrap_err();
    let words = "model.obj: would take up to 6.3 GB of memory with its 10000000 corners of 10000 faces, \
                 10000 positions and 0 meshes; at most 0.0 GB are taken";
    assert_eq!(refused, words);
    let libraries = Limits { libraries: 3, ..Limits::DEFAULT };
    let refused = load_files(&[("model.obj", b"mtllib a\nmtllib b b\nmtllib c\n")], &libraries);
    assert_eq!(
        refused.unwrap_err(),
        "model.obj:3: more than 3 MTL files, the most that are looked for"
    );
}

#[test]
fn more_than_the_limits() {
    let few = Limits { meshes: 1, obj_bytes: 100, ..Limits::DEFAULT };
    let most = ", the most that are read";
    for (obj, message) in [
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
        message.ends_with("model.obj: is too large: 536870913 bytes, at most 536870912 are read"),
        "{message}"
    );
}
