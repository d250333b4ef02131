//! MTL files: the statements read, and those refused.

use super::super::obj::tests::{TRIANGLE, load_files, load_text};
use super::*;
use crate::scene::Microfacet;
use glam::Vec3;

/// Reads an MTL file through an OBJ file that uses its first material.
fn load_mtl(mtl: &str) -> Result<Material, String> {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 2] = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    let model = load_files(&files, &Limits::DEFAULT)?;
    Ok(model.materials[model.meshes[0].material].clone())
}

/// As [`load_mtl`], with the warnings.
fn load_warned(mtl: &str) -> (Material, Vec<String>) {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 2] = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    (model.materials[model.meshes[0].material].clone(), model.warnings)
}

/// Line 2, after `newmtl a`, is ignored.
#[track_caller]
fn line_ignored(line: &str, message: &str) {
    let (material, warnings) = load_warned(&format!("newmtl a\n{line}\n"));
    assert_eq!(warnings, [format!("m.mtl:2: {message}; the line is ignored (1 in all)")]);
    assert_eq!(material, Material { name: "a".to_owned(), ..Material::default() });
}

/// Another number is taken on line 2, after `newmtl a`.
#[track_caller]
fn line_corrected(line: &str, message: &str, set: impl Fn(&mut Material)) {
    let (material, warnings) = load_warned(&format!("newmtl a\n{line}\n"));
    assert_eq!(warnings, [format!("m.mtl:2: {message} is taken (1 in all)")]);
    let mut expected = Material { name: "a".to_owned(), ..Material::default() };
    set(&mut expected);
    assert_eq!(material, expected, "{line}");
}

#[test]
fn every_statement_is_read() {
    let mtl = "# one\nnewmtl a\nKa 1 1 1\n Kd 0.1 0.2 0.3 # red\nKs 0.5\nKe 9 8 7\nNs 20\nNi 1.5\n\
               Tf 0.9 1 0.8\nd 0.25\nTr 0.1\nillum 2\nPr 0.3\nPm 0.75\nPc 1\nmap_Ks -s 1 1 1 nowhere.png\nmap_Bump ../x.png\n";
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
        microfacet: Some(Microfacet {
            color: Vec3::new(0.1, 0.2, 0.3),
            roughness: 0.3,
            metallic: 0.75,
            ..Microfacet::default()
        }),
        ..Material::default()
    };
    assert_eq!(load_mtl(mtl).unwrap(), expected);
    assert_eq!(load_mtl(&mtl.to_uppercase().replace("NEWMTL A", "newmtl a")).unwrap(), expected);
    let unread =
        |line: usize, what: &str| format!("m.mtl:{line}: {what}; the line is ignored (1 in all)");
    let lines = [
        unread(
            15,
            "Pc is a property of physically based materials that is not read; Pr, Pm, map_Pr and map_Pm are",
        ),
        unread(16, "map_Ks is a map of highlights, which is not read; Ks and Ns are"),
        "m.mtl:17: map_Bump names \"../x.png\", outside the OBJ file's folder; copy it into the folder; the surface is \
         smooth (1 in all)"
            .to_owned(),
    ];
    assert_eq!(load_warned(mtl).1, lines);
    assert!(expected.has_cutout() && !Material::default().has_cutout());
    assert_eq!(load_mtl("newmtl a\r\nTr 0.25\r\n").unwrap().opacity, 0.75);
}

#[test]
fn lines_that_are_wrong_are_ignored() {
    line_ignored("Kd red", "Kd has \"red\", which is not a number");
    line_ignored("Kd nan 0 0", "Kd has \"nan\", which is not a finite 32-bit number");
    line_ignored("Ks 0,5 0 0", "Ks has \"0,5\", which is not a number; write 0.5");
    line_ignored("Ke 0 1e40 0", "Ke has \"1e40\", which is not a finite 32-bit number");
    line_ignored("Ks 0 1", "Ks has 2 numbers; a colour has 3, or 1 for a grey");
    line_ignored("Ks", "Ks has 0 numbers; a colour has 3, or 1 for a grey");
    line_ignored("Tf 1 1", "Tf has 2 numbers; a colour has 3, or 1 for a grey");
    line_ignored("Ns", "Ns is not followed by a number");
    line_ignored("d -1.#IND", "d has \"-1.#IND\", which is not a finite 32-bit number");
    line_ignored("illum 11", "illum \"11\" is not a whole number from 0 to 9");
    line_ignored("illum", "illum \"\" is not a whole number from 0 to 9");
    line_ignored("illum 10", "illum 10 is a surface of which only the shadows on it are seen");
    let (_, warnings) = load_warned("Kd 1 1 1\nnewmtl a\n");
    let before = "Kd stands before the first newmtl; the line is ignored (1 in all)";
    assert_eq!(warnings, [format!("m.mtl:1: {before}")]);
}

#[test]
fn words_that_are_unknown_are_reported_once_each() {
    let is_not = |word: &str| {
        format!(
            "{word:?} is not a keyword of an MTL file, as newmtl, Kd, Ks, Ke, Ns, Ni, d, Tr, illum and map_Kd \
             are; the line is ignored"
        )
    };
    let (_, warnings) = load_warned("newmtl a\nilum 4\nKdd 1 1 1\nilum 2\n");
    let lines = [
        format!("m.mtl:2: {} (2 in all)", is_not("ilum")),
        format!("m.mtl:3: {} (1 in all)", is_not("Kdd")),
    ];
    assert_eq!(warnings, lines);
    let (material, warnings) =
        load_warned("newmtl a\nka 0.3 0.2 0.03\nkd 0.8 0.1 0.1\nKS 0 0 0\nILLUM 0\n");
    assert_eq!((material.base_color, material.illumination), (Vec3::new(0.8, 0.1, 0.1), 0));
    assert_eq!(warnings, [""; 0]);
}

#[test]
fn what_is_not_shown_is_one_warning_for_a_kind() {
    let kinds = [
        ("map_disp a.png\ndisp a.png", "map_disp is a map of displacement"),
        ("map_Ns a.png\nmap_Ks a.png", "map_Ns is a map of highlights"),
        ("MAP_KE a.png", "MAP_KE is a map of emission"),
        ("map_Tr a.png", "map_Tr is a map of what a material lets through"),
        ("refl -type sphere a.png", "refl is a picture to be reflected"),
        ("decal a.png", "decal is a second texture"),
        ("Ps 1\nPc 1\nmap_ORM a.png", "Ps is a property of physically based materials"),
        // Without them a picture is the same.
        ("Ka 1 1 1\nmap_Ka a.png\nsharpness 60\nmap_aat on\nPs 0.0\nPc 0\naniso 0\nanisor 0", ""),
    ];
    for (lines, what) in kinds {
        let (material, warnings) = load_warned(&format!("newmtl a\n{lines}\n{lines}\n"));
        assert_eq!(material, Material { name: "a".to_owned(), ..Material::default() });
        let count = 2 * lines.lines().count();
        let end = format!("; the line is ignored ({count} in all)");
        let told =
            |line: &String| line.starts_with(&format!("m.mtl:2: {what}")) && line.ends_with(&end);
        assert_eq!(warnings.len(), usize::from(!what.is_empty()), "{warnings:?}");
        assert!(warnings.iter().all(told), "{warnings:?}");
    }
}

#[test]
fn numbers_out_of_range_are_corrected() {
    let negative = "and cannot be negative";
    line_corrected("Ns -1.960784", &format!("Ns is -1.960784, {negative}; 0"), |_| {});
    line_corrected("Ni -1", &format!("Ni is -1, {negative}; 1"), |_| {});
    line_corrected("Tr -0.0001", &format!("Tr is -0.0001, {negative}; 0"), |_| {});
    let most = "and cannot be more than 1; 1";
    line_corrected("d 1.000001", &format!("d is 1.000001, {most}"), |_| {});
    line_corrected("d 255", &format!("d is 255, {most}"), |_| {});
    line_corrected(
        "Kd 1.2 0.5 -0.1",
        "Kd is 1.2 0.5 -0.1; a colour is from 0 to 1: 1 0.5 0",
        |m| {
            m.base_color = Vec3::new(1.0, 0.5, 0.0);
        },
    );
    line_corrected(
        "Kd 200 100 50",
        "Kd is 200 100 50, perhaps from 0 to 255; a colour is from 0 to 1: 0.784 0.392 0.196",
        |m| m.base_color = Vec3::new(200.0, 100.0, 50.0) / 255.0,
    );
    line_corrected("Ks 9", "Ks is 9 9 9; a colour is from 0 to 1: 1 1 1", |m| {
        m.specular = Vec3::ONE
    });
    line_corrected("Tf 2 1 1", "Tf is 2 1 1; a colour is from 0 to 1: 1 1 1", |_| {});
    line_corrected(
        "Ke 1e38 1 1",
        "Ke is 1e38 1 1; a colour is from 0 to 1000000: 1000000 1 1",
        |m| m.emission = Vec3::new(1e6, 1.0, 1.0),
    );
    let four = load_warned("newmtl a\nKd 0.8 0.2 0.1 1.0\nNs 10 20\nillum 2.0\n");
    assert_eq!((four.0.base_color, four.0.shininess), (Vec3::new(0.8, 0.2, 0.1), 10.0));
    assert_eq!(four.0.illumination, 2);
    let bytes = load_warned("newmtl a\nKd 255 0 0 255\n");
    assert_eq!((bytes.0.base_color, bytes.1.len()), (Vec3::X, 2));
    assert_eq!(
        four.1,
        [
            "m.mtl:2: Kd has 4 numbers; a colour has 3, which are taken (1 in all)",
            "m.mtl:3: Ns has 2 numbers; the first is taken (1 in all)",
        ]
    );
}

#[test]
fn a_material_of_which_nothing_would_be_seen_is_shown() {
    let opaque = "nothing is seen of a material with d 0 or Tr 1, which some programs write for an opaque one; \
                  it is shown opaque; to hide it, write d 0.001 (1 in all)";
    for line in ["Tr 1.000000", "d 0", "Tr 1", "D 0.0"] {
        let (material, warnings) = load_warned(&format!("newmtl a\n{line}\nillum 2\n"));
        assert_eq!((material.opacity, material.has_cutout()), (1.0, false), "{line}");
        assert_eq!(warnings, [format!("m.mtl:2: {opaque}")]);
    }
    let (material, warnings) = load_warned("newmtl a\nd -0.0001\n");
    assert_eq!((material.opacity, warnings.len()), (1.0, 2), "{warnings:?}");
    assert_eq!(load_warned("newmtl a\nd 1\nTr 1\n").0.opacity, 1.0);
    assert_eq!(load_warned("newmtl a\nd 0.001\n").0.opacity, 0.001);
    let (material, warnings) = load_warned("newmtl a\nillum 7\nNi 1.5\nd 0\n");
    assert_eq!((material.opacity, material.illumination, warnings.len()), (1.0, 7, 0));

    let cure = "for glass, write Ni 1.5 (1 in all)";
    for index in ["Ni 1.00", "Ni 0", ""] {
        let (material, warnings) = load_warned(&format!("newmtl a\nillum 4\n{index}\nTf 1 1 1\n"));
        assert_eq!((material.illumination, material.refraction), (3, 1.0));
        let what =
            "illum 4 is glass, of which nothing is seen with Ni 1 and Tf 1; illum 3 is taken";
        assert_eq!(warnings, [format!("m.mtl:2: {what}; {cure}")]);
    }
    let (material, warnings) = load_warned("newmtl a\nillum 6\nTf 1 0.5 1\n");
    assert_eq!(material.illumination, 6);
    let what = "illum 6 is glass, of which only Tf is seen with Ni 1";
    assert_eq!(warnings, [format!("m.mtl:2: {what}; {cure}")]);
    assert_eq!(load_warned("newmtl a\nillum 4\nNi 1.5\n").1, [""; 0]);
}

/// The material of an MTL file with a texture, and the warnings.
fn textured(obj: &str, mtl: &str) -> (Material, Vec<String>) {
    let obj = format!("mtllib m.mtl\nusemtl a\n{obj}");
    let texel = super::super::texture::tests::png(&[[1, 2, 3, 4]], 1);
    let files: [(&str, &[u8]); 3] =
        [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("t.png", &texel)];
    let mut model = load_files(&files, &Limits::DEFAULT).unwrap();
    (model.materials.remove(0), model.warnings)
}

#[test]
fn a_texture_is_seen() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    let (material, warnings) = textured(obj, "newmtl a\nKd 0 0 0\nmap_Kd t.png\n");
    assert_eq!(material.base_color, Vec3::ONE);
    let black = "Kd 0 makes the texture of map_Kd black; the texture is shown as it is; for black, leave map_Kd out";
    assert_eq!(warnings, [format!("m.mtl:2: {black} (1 in all)")]);
    let (material, warnings) = textured(obj, "newmtl a\nmap_kd t.png\nKd 0.5 0 0\n");
    assert_eq!((material.base_color, warnings.len()), (Vec3::new(0.5, 0.0, 0.0), 0));
    // A file that cannot be read leaves the colour.
    let (material, _) = textured(obj, "newmtl a\nmap_Kd m.mtl\nKd 0 0 0\n");
    assert_eq!(material.base_color, Vec3::ZERO);

    for (keyword, instead) in [
        ("map_Kd", "one texel counts for the whole face"),
        ("map_d", "one texel counts for the whole face"),
        ("bump", "the surface is smooth"),
    ] {
        let (_, warnings) = textured(TRIANGLE, &format!("newmtl a\n{keyword} t.png\n"));
        let what = "is on faces without texture coordinates; write vt, and f with v/vt";
        let start = format!("m.mtl:2: {keyword} {what}; {instead} (1 in all)");
        assert!(warnings.contains(&start), "{warnings:?}");
    }
    assert_eq!(textured(TRIANGLE, "newmtl a\nnewmtl b\nmap_Kd t.png\n").1, [""; 0]);
}

#[test]
fn files_that_are_binary() {
    let files: [(&str, &[u8]); 2] =
        [("model.obj", b"mtllib m.mtl\nv 0 0 0\nf 1 1 1\n"), ("m.mtl", b"a\nb\0")];
    let words =
        "m.mtl:2: holds a zero byte: this is a binary file, not text; its materials are not known";
    let warnings = load_files(&files, &Limits::DEFAULT).unwrap().warnings;
    assert!(warnings.iter().any(|line| line.starts_with(words)), "{warnings:?}");
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
    let words = "model.obj:1: mtllib names \".\", which is a folder";
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
        let found = after_options(rest, &mut |_: &str, _: &str| options += 1);
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

#[test]
fn metalness_and_roughness_complete_each_other() {
    let of = |lines: &str| {
        let (material, warnings) = load_warned(&format!("newmtl a\nKd 1 0.5 0\nNs 30\n{lines}\n"));
        (material.microfacet, warnings)
    };
    let gold = Microfacet { color: Vec3::new(1.0, 0.5, 0.0), ..Microfacet::default() };
    assert_eq!(of(""), (None, vec![]));
    assert_eq!(of("Pr 0.25").0, Some(Microfacet { roughness: 0.25, ..gold.clone() }));
    // As wide as the highlight of 30: alpha is the root of 2 / 32.
    assert_eq!(of("Pm 1").0, Some(Microfacet { roughness: 0.5, metallic: 1.0, ..gold.clone() }));
    assert_eq!(of("Pm 1\nPr 0").0, Some(Microfacet { roughness: 0.0, metallic: 1.0, ..gold }));
    let (microfacet, warnings) = of("Pr 1.5\nPm -1");
    assert_eq!(microfacet.map(|m| (m.roughness, m.metallic)), Some((1.0, 0.0)));
    let lines = [
        "m.mtl:4: Pr is 1.5, and cannot be more than 1; 1 is taken (1 in all)",
        "m.mtl:5: Pm is -1, and cannot be negative; 0 is taken (1 in all)",
    ];
    assert_eq!(warnings, lines);
}
