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
    refused("# nothing\nv 0 0 0\no empty\n", "model.obj: has no faces");
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
    refused("v 0 0 0\nv 1 -", &format!("model.obj:2: v has \"-\", which is not a number{hint}"));
}

#[test]
fn numbers_that_are_wrong() {
    let wrong = |line: &str, what: &str| {
        let warning = format!("model.obj:4: {what}; the faces that use it are left out (1 in all)");
        // The positions after it keep their numbers.
        let text = |faces: &str| format!("v 0 0 0\nv 1 0 0\nv 1 1 0\n{line}\nv 0 1 0\n{faces}");
        let model = load_text(&text("f 1 2 3\nf 1 2 3 4\nf 4 3 2\nf 1 3 5\n")).unwrap();
        assert_eq!(model.warnings, [warning]);
        let shown = load_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n").unwrap();
        assert_eq!(model.meshes, shown.meshes, "{line}");
        // Without any other face, it is the reason why nothing is shown.
        refused(&text("f 1 2 4\n"), &format!("model.obj:4: {what}"));
    };
    wrong("v 1,0 2 3", "v has \"1,0\", which is not a number; write 1.0");
    for nan in ["nan", "NaN", "-nan(ind)", "inf", "-Infinity", "1e39", "-1.#IND"] {
        let why = if nan.contains('(') { "not a number" } else { "not a finite 32-bit number" };
        wrong(&format!("v 1 {nan} 3"), &format!("v has \"{nan}\", which is {why}"));
    }
    wrong("v 1 2 # 3", "v has 2 numbers; x y z, x y z w or x y z r g b is right");
    wrong("v", "v has 0 numbers; x y z, x y z w or x y z r g b is right");
    wrong("v 1 2 3 0", "a position divided by its w is not finite");
    wrong("v 1 2 3e38 0.1", "a position divided by its w is not finite");
}

#[test]
fn wrong_positions_are_one_warning_and_stay_out_of_everything() {
    let wrong = "v nan 0 0\nv 0 0 inf\nv 0 0\n";
    let good = "v 5e5 0 0\nv 500001 0 0\nv 500001 1 0\nv 5e5 1 0\ns 1\n";
    let faces = "f -4 -3 -2\nf -4 -2 -1\n";
    let with = load_text(&format!("{wrong}{good}f 1 4 5\nf 4 5 6 2\nf 3 3 3\n{faces}")).unwrap();
    let without = load_text(&format!("{good}{faces}")).unwrap();
    assert_eq!(with.meshes, without.meshes);
    let words = "model.obj:1: v has \"nan\", which is not a finite 32-bit number; the faces that use it are \
                 left out (3 in all)";
    assert_eq!(with.warnings[0], words);
    assert_eq!(with.warnings[1..], without.warnings);
    // After the limit nothing is stored, and so nothing is known of a position.
    let limits = Limits { memory: 4_000_000, ..Limits::DEFAULT };
    let many = format!("v nan 0 0\nv 0 0 0\nf{}\n", " 2".repeat(1000)).repeat(10_000);
    let error = load_files(&[("model.obj", many.as_bytes())], &limits).unwrap_err();
    assert!(error.starts_with("model.obj: would take up to 6.2 GB of memory"), "{error}");
}

#[test]
fn numbers_that_a_model_can_do_without() {
    let flat = "the triangle's own stands for it";
    let line = |what: &str, more: &str| format!("model.obj:7: {what}; {more}");
    for normal in ["nan nan nan", "-1.#IND 0 1", "0 1.#QNAN 0", "inf 0 0", "0 -nan(ind) 0"] {
        let model = load_text(&format!(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn {normal}\nvn 1 0 0\nf 1//1 2//2 3//1\n"
        ))
        .unwrap();
        let vertices = &model.meshes[0].vertices;
        let normals: Vec<_> = vertices.iter().map(|vertex| vertex.normal).collect();
        assert_eq!(normals, [Vec3::Z, Vec3::X, Vec3::Z], "{normal}");
        assert!(model.warnings[0].starts_with("model.obj:4: vn has \""), "{:?}", model.warnings);
        assert!(model.warnings[0].ends_with("; the triangle's own stands for it (1 in all)"));
    }
    lines_warned(
        "vn 0 0 0\nvn 0 1",
        &[&line("vn is 0 0 0, which has no direction", &format!("{flat} (2 in all)"))],
    );
    lines_warned(
        "vn 0 1",
        &[&line("vn has 2 numbers; x y z is right", &format!("{flat} (1 in all)"))],
    );
    lines_warned(
        "vn 0 1 0 0",
        &[&line("vn has 4 numbers; x y z is right", "the first 3 are taken (1 in all)")],
    );
    lines_warned("vn 0 1 0 # up", &[]);
    lines_warned(
        "vt 0 0 0 1",
        &[&line("vt has 4 numbers; u, u v or u v w is right", "the first 2 are taken (1 in all)")],
    );
    let none = "the corner has none (1 in all)";
    lines_warned("vt # 0 0", &[&line("vt has no numbers; u, u v or u v w is right", none)]);
    lines_warned(
        "vt 0 1e39",
        &[&line("vt has \"1e39\", which is not a finite 32-bit number", none)],
    );
    let forms = "x y z, x y z w or x y z r g b is right";
    lines_warned(
        "v 1 2 3 4 5",
        &[&line(&format!("v has 5 numbers; {forms}"), "the first 3 are taken (1 in all)")],
    );
    let color = "v has a colour, and colours of vertices are not shown; write a material or a texture; \
                 the material's stands for it (2 in all)";
    lines_warned("v 1 2 3 1 0 0\nv 1 2 3 0 1 0", &[&format!("model.obj:7: {color}")]);
}

#[test]
fn faces_that_are_wrong() {
    let whole = " is out of range: the file has";
    let left_out = |face: &str, what: &str| {
        let line = format!("model.obj:7: {what}; the face is left out (1 in all)");
        lines_warned(face, &[&line]);
        // Without any other face, it is the reason why nothing is shown.
        let alone = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\n\n{face}\n");
        assert_eq!(load_text(&alone).unwrap_err(), format!("model.obj:7: {what}"));
    };
    left_out("f 1 2 99", &format!("face index 99{whole} 4 positions up to this line"));
    left_out("f 1 2 -5", &format!("face index -5{whole} 4 positions up to this line"));
    left_out("f 1 2 0", "face index 0 is out of range: indices start at 1, or at -1 backwards");
    left_out("f 1 2 3.5", "face index \"3.5\" is not a whole number");
    left_out("f 1 2 /1", "face index \"\" is not a whole number");
    left_out(
        "f 1/1/1/1 2 3",
        "the corner \"1/1/1/1\" has too many parts; v, v/vt, v//vn or v/vt/vn is right",
    );
    left_out("f 1 2 # 3", "a face has 2 corners; it needs at least 3");
    left_out("f", "a face has 0 corners; it needs at least 3");
    let huge = format!("f 1 2 {}", i64::MIN);
    left_out(&huge, &format!("face index {}{whole} 4 positions up to this line", i64::MIN));
    lines_warned(
        "f 1 2\nf 1 2 9\nf 3",
        &[
            "model.obj:7: a face has 2 corners; it needs at least 3; the face is left out (3 in all)",
        ],
    );
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
    lines_warned(
        "f 1//x 2 3",
        &[&format!("model.obj:7: normal index \"x\" is not a whole number; {flat} (1 in all)")],
    );
}

#[test]
fn statements_of_other_formats_are_passed_over() {
    let hint = "is not a keyword of an OBJ file, as v, vt, vn, f, o, g, s, usemtl and mtllib are";
    let warning = |line: usize, word: &str, count: usize| {
        format!("model.obj:{line}: \"{word}\" {hint}; the line is ignored ({count} in all)")
    };
    lines_warned(
        "group a b\ncurve 1 2\ngroup",
        &[&warning(7, "group", 2), &warning(8, "curve", 1)],
    );
    // Every word once, but not a thousand of them.
    let words: String = (0..1000).map(|i| format!("word{i}\n")).collect();
    let mut lines: Vec<_> = (0..8).map(|i| warning(7 + i, &format!("word{i}"), 1)).collect();
    lines.push(warning(15, "word8", 992));
    let lines: Vec<_> = lines.iter().map(String::as_str).collect();
    lines_warned(&words, &lines);
    lines_warned(
        "s one",
        &[
            "model.obj:7: \"one\" is not a smoothing group, which is a whole number, or off; the line is ignored (1 in all)",
        ],
    );
    let upper =
        "V 0 0 0\nV 1 0 0\nV 0 1 0\nVT 0 0\nVn 0 0 1\nO a\nS off\nUSEMTL x\nF 1/1/1 2/1/1 3/1/1\n";
    let lower = load_text(&upper.to_lowercase()).unwrap();
    assert_eq!(load_text(upper).unwrap(), lower);
    let known = "s off\nvp 0.5\ncstype bezier\ndeg 3\nend\nlod 2\nbevel on\nmg 1 0.5";
    lines_warned(known, &[]);
}

#[test]
fn elements_that_no_ray_can_hit_have_a_warning_each() {
    lines_warned(
        "l 1 2\np 1\nl 2 3\nL 3 1\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2\nusemap a\nshadow_obj a.obj",
        &[
            "model.obj:7: l is a line, which no ray can hit; write faces; the line is ignored (3 in all)",
            "model.obj:8: p is a point, which no ray can hit; write faces; the line is ignored (1 in all)",
            "model.obj:11: curv is a curve, which no ray can hit; write faces; the line is ignored (1 in all)",
            "model.obj:12: surf is a free-form surface, which is not read; export it as faces; the line is \
             ignored (1 in all)",
            "model.obj:13: usemap is a texture of its own, which is not read; the map_Kd of a material is; the \
             line is ignored (1 in all)",
            "model.obj:14: shadow_obj is another body for shadows, which is not read; the faces cast them; the \
             line is ignored (1 in all)",
        ],
    );
    let only_lines = load_text("v 0 0 0\nv 1 0 0\nl 1 2\n").unwrap_err();
    assert_eq!(only_lines, "model.obj:3: l is a line, which no ray can hit; write faces");
}

#[test]
fn what_takes_too_much_memory_is_refused_with_all_that_it_would_take() {
    // A triangle needs 620 bytes, and a corner is written in two.
    let limits = Limits { memory: 4_000_000, ..Limits::DEFAULT };
    let polygon = |corners: usize| format!("v 0 0 0\nf{}\n", " 1".repeat(corners));
    let load = |text: &str| load_files(&[("model.obj", text.as_bytes())], &limits);
    load(&polygon(1000).repeat(5)).unwrap();
    let refused = load(&polygon(1000).repeat(10_000)).unwrap_err();
    let words = "model.obj: would take up to 6.2 GB of memory with its 10000000 corners of 10000 faces, \
                 10000 positions and 1 meshes; at most 0.0 GB are taken";
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
        (
            "v 0 0 0\no a\nf 1 1 1\no b\nf 1 1 1\n".into(),
            format!(":5: more than 1 objects and materials{most}"),
        ),
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
