//! MTL files: the statements read, and those refused.

use super::super::obj::tests::{TRIANGLE, load_files, load_text, warnings};
use super::*;

/// Reads an MTL file through an OBJ file that uses its first material.
fn load_mtl(mtl: &str) -> Result<Material, String> {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 2] = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    let model = load_files(&files, &Limits::DEFAULT)?;
    Ok(model.materials[model.meshes[0].material].clone())
}

/// Line 2, after `newmtl a`, is wrong.
#[track_caller]
fn line_refused(line: &str, message: &str) {
    let error = load_mtl(&format!("newmtl a\n{line}\nillum 1\n")).unwrap_err();
    assert_eq!(error, format!("m.mtl:2: {message}"));
}

#[test]
fn every_statement_is_read() {
    let mtl = "# one\nnewmtl a\nKa 1 1 1\n Kd 0.1 0.2 0.3 # red\nKs 0.5\nKe 9 8 7\nNs 20\nNi 1.5\n\
               Tf 0.9 1 0.8\nd 0.25\nTr 0.1\nillum 2\nPr 0.3\nmap_Ks -s 1 1 1 nowhere.png\nmap_Bump ../x.png\n";
    let expected = Material {
        name: "a".to_owned(),
        base_color: Vec3::new(0.1, 0.2, 0.3),
        specular: Vec3::splat(0.5),
        shininess: 20.0,
        emission: Vec3::new(9.0, 8.0, 7.0),
        opacity: 0.25,
        illumination: 2,
        refraction: 1.5,
        transmission: Vec3::new(0.9, 1.0, 0.8),
        ..Material::default()
    };
    assert_eq!(load_mtl(mtl).unwrap(), expected);
    assert!(expected.has_cutout() && !Material::default().has_cutout());
    assert_eq!(load_mtl("newmtl a\r\nTr 0.25\r\n").unwrap().opacity, 0.75);
}

#[test]
fn numbers_that_are_wrong() {
    line_refused("Kd red", "\"red\" is not a number");
    line_refused("Kd nan 0 0", "\"nan\" is not a finite 32-bit number");
    line_refused("Ke 0 1e40 0", "\"1e40\" is not a finite 32-bit number");
    line_refused("Ke 1 1 1e38", "Ke is 1e38; it cannot be more than 1000000");
    line_refused("Ks 1e38", "Ks is 1e38; it cannot be more than 1000000");
    line_refused("Kd 0 -0.5 0", "Kd has a negative number; a colour has none");
    line_refused("Ks 0 1", "Ks has 2 numbers; a colour has 3, or 1 for a grey");
    line_refused("Ks", "Ks has 0 numbers; a colour has 3, or 1 for a grey");
    line_refused("Ni -1", "Ni is -1; it cannot be negative");
    line_refused("Tf 1 1", "Tf has 2 numbers; a colour has 3, or 1 for a grey");
    line_refused("Ns -1", "Ns is -1; it cannot be negative");
    line_refused("Ns", "Ns is not followed by a number");
    line_refused("d 1.5", "d is 1.5; it cannot be more than 1");
    line_refused("illum 11", "illum \"11\" is not a whole number from 0 to 10");
    line_refused("illum", "illum \"\" is not a whole number from 0 to 10");
}

#[test]
fn names_that_are_wrong() {
    let error = load_mtl("Kd 1 1 1\nnewmtl a\n").unwrap_err();
    assert_eq!(error, "m.mtl:1: Kd stands before the first newmtl");
    let files: [(&str, &[u8]); 3] =
        [("model.obj", b"mtllib m.mtl n.mtl\n"), ("m.mtl", b"newmtl a\n"), ("n.mtl", b"\nNs 1\n")];
    let error = load_files(&files, &Limits::DEFAULT).unwrap_err();
    assert_eq!(error, "n.mtl:2: Ns stands before the first newmtl");
    let files: [(&str, &[u8]); 2] =
        [("model.obj", b"mtllib m.mtl\nv 0 0 0\nf 1 1 1\n"), ("m.mtl", b"a\nb\0")];
    let words =
        "m.mtl:2: holds a zero byte: this is a binary file, not text; its materials are not known";
    assert!(warnings(&files)[0].starts_with(words), "{:?}", warnings(&files));
}

#[test]
fn files_that_are_wrong() {
    let outside = |name: &str| {
        let model = load_text(&format!("\nmtllib {name}\n{TRIANGLE}")).unwrap();
        let words = format!(
            "model.obj:2: mtllib names {name:?}, outside the OBJ file's folder; copy it into the folder; its \
             materials are not known (1 in all)"
        );
        assert_eq!(model.warnings, [words]);
    };
    for name in ["../m.mtl", "/etc/passwd", "C:\\m.mtl"] {
        outside(name);
    }
    let folder = load_text(&format!("mtllib .\n{TRIANGLE}")).unwrap();
    let words = "model.obj:1: mtllib names \".\", which is no file";
    assert!(folder.warnings[0].starts_with(words), "{:?}", folder.warnings);
    let files: [(&str, &[u8]); 2] = [("model.obj", b"mtllib m.mtl\n"), ("m.mtl", b"newmtl a\n")];
    let few = Limits { mtl_bytes: 8, ..Limits::DEFAULT };
    let error = load_files(&files, &few).unwrap_err();
    assert_eq!(error, "m.mtl: is too large: 9 bytes, at most 8 are read");
    let files: [(&str, &[u8]); 3] =
        [("model.obj", b"mtllib a b\n"), ("a", b"newmtl a\n"), ("b", b"newmtl b\nnewmtl c\n")];
    let few = Limits { mtl_bytes: 20, ..Limits::DEFAULT };
    let error = load_files(&files, &few).unwrap_err();
    let words = "b: is too large: with the MTL files before it 27 bytes, at most 20 are read";
    assert_eq!(error, words);
    let few = Limits { materials: 2, ..Limits::DEFAULT };
    let error = load_files(&files, &few).unwrap_err();
    assert_eq!(error, "b:2: more than 2 materials, the most that are read");
}

#[test]
fn options_stand_before_the_name_of_a_texture() {
    for (rest, name, count) in [
        ("t 1.png", "t 1.png", 0),
        ("-s 1 1 1 t.png", "t.png", 1),
        ("-s 2 1.png", "1.png", 1),
        ("-o 0.5 0 -bm 0.2 -clamp on my t.png", "my t.png", 3),
        ("-mm 0 1 -imfchan l -type sphere a.png", "a.png", 3),
        ("-strange.png", "-strange.png", 0),
        ("-bm", "", 1),
        ("", "", 0),
    ] {
        let mut options = 0;
        let found = after_options(rest, &mut |_: &str| options += 1);
        assert_eq!((found, options), (name, count), "{rest}");
    }
}

#[test]
fn faces_without_material_get_the_default_after_the_others() {
    let obj =
        format!("{TRIANGLE}mtllib a b.mtl\nmtllib c.mtl sub/d.mtl c.mtl\nusemtl d\nf 1 2 3\n");
    let files: [(&str, &[u8]); 4] = [
        ("model.obj", obj.as_bytes()),
        ("a b.mtl", b"newmtl x\n"),
        ("c.mtl", b"newmtl c\n"),
        ("sub/d.mtl", b"newmtl d\n"),
    ];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    let names: Vec<_> = model.materials.iter().map(|material| &material.name).collect();
    assert_eq!(names, ["x", "c", "d", "default"]);
    assert_eq!(model.meshes.iter().map(|mesh| mesh.material).collect::<Vec<_>>(), [3, 2]);
    assert_eq!(model.materials[3], Material::default());
}
