//! Warnings about materials, and the replacements for missing parts.

use super::super::limits::Limits;
use super::super::obj::tests::{TRIANGLE, load_files, load_text, warnings};
use crate::scene::material::Material;
use glam::Vec3;

/// The warnings for a model that uses `a` on line 2.
#[track_caller]
fn warned(obj: &str, mtl: &str) -> Vec<String> {
    let obj = format!("{obj}usemtl a\n{TRIANGLE}");
    warnings(&[("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())])
}

#[test]
fn materials_that_are_not_there_are_grey() {
    let grey = "a grey stands for it";
    let undefined = "the material \"a\" is not defined; the mtllib files hold";
    assert_eq!(
        warned("mtllib m.mtl\n", "newmtl b\nnewmtl c #2\n"),
        [format!("model.obj:2: {undefined} \"b\", \"c #2\"; {grey} (1 in all)")]
    );
    assert_eq!(
        warned("usemtl\n", ""),
        [format!(
            "model.obj:1: the material \"(no name)\" is not defined; the mtllib files hold no \
             material; {grey} (2 in all)"
        )]
    );
    let unknown = "its materials are not known";
    assert_eq!(
        warned("mtllib gone.mtl\n", ""),
        [
            format!(
                "model.obj:1: mtllib names \"gone.mtl\", which is not there; {unknown} (1 in all)"
            ),
            format!("model.obj:2: {undefined} no material; {grey} (1 in all)"),
        ]
    );
    let all = |obj: &str| warned(obj, "newmtl a\n");
    assert_eq!(
        all("mtllib\nmtllib gone a.mtl\nmtllib m.mtl gone.mtl\n"),
        [format!("model.obj:1: mtllib is not followed by a name; {unknown} (3 in all)")]
    );
    let spaces = format!(
        "model.obj:1: mtllib names \"gone a.mtl\", which is not there; {unknown} (1 in all)"
    );
    assert_eq!(all("mtllib gone a.mtl\nmtllib m.mtl\n"), [spaces]);
    assert_eq!(warned("mtllib m.mtl\nusemtl\n", "newmtl\nKd 1 0 0\nnewmtl a\n"), [""; 0]);
    // A file after the use also provides the definition.
    assert_eq!(all("usemtl a\nmtllib m.mtl\n"), [""; 0]);
    let model = load_text(&format!("usemtl a\n{TRIANGLE}usemtl b\nf 1 2 3\n")).unwrap();
    assert_eq!(model.materials, [Material::default()]);
}

#[test]
fn statements_that_are_not_supported_are_passed_over() {
    let mtl = "newmtl a\nKd 1 0 0\nKs spectral a.rfl 2\nKe xyz 1 1 1\nd -halo 0.5\n\
               map_Kd -bm 0.2 gone.png\n";
    let files = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 2] = [("model.obj", files.as_bytes()), ("m.mtl", mtl.as_bytes())];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    assert_eq!(
        model.warnings,
        [
            "m.mtl:3: Ks has the form spectral, which is not supported; it is ignored (4 in all)",
            "m.mtl:6: map_Kd names \"gone.png\", which is not there; the plain colour stands for \
             it (1 in all)",
        ]
    );
    let material = &model.materials[0];
    assert_eq!((material.base_color, material.opacity), (Vec3::X, 0.5));
    assert_eq!(material.base_texture, None);
}

#[test]
fn the_first_definition_of_a_material_stands() {
    let mtl = "newmtl a\nKd 1 0 0\nnewmtl b\nnewmtl a\nKd nonsense\nnewmtl c\nKd 0 0 1\n";
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 2] = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    let colors: Vec<_> = model.materials.iter().map(|m| m.base_color).collect();
    assert_eq!(colors, [Vec3::X, Vec3::splat(0.5), Vec3::Z]);
    let first = "m.mtl:4: the material \"a\" is defined at m.mtl:1 already";
    assert_eq!(model.warnings, [format!("{first}; the first definition stands (1 in all)")]);
}
