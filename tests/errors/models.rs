//! `--scene`: a fault in a model is reported with file and line. If the model can be shown without the faulty
//! part it is, otherwise it is refused.

use std::fs;
use std::path::Path;

use crate::{refused_by, sample};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Writes files into a new folder and renders `model.obj` with the folder as the current one.
fn command(files: &[(&str, &[u8])]) -> (tempfile::TempDir, std::process::Command) {
    let folder = folder(files);
    let mut command = sample();
    command.current_dir(&folder).args(["--scene", "model.obj"]);
    (folder, command)
}

/// A new folder with files in it.
fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

#[track_caller]
fn files_refused(files: &[(&str, &[u8])], words: &[&str]) {
    let (_folder, command) = command(files);
    refused_by(command, 1, words);
}

#[test]
fn a_gltf_file_is_shown_or_refused() {
    let assets = run::root().join("samples/assets");
    let file = |name: &str| fs::read(assets.join(name)).unwrap();
    let (json, buffer, picture) = (file("chess.gltf"), file("chess.bin"), file("fretwork.png"));
    let normals = file("bevelled.png");
    let whole: [(&str, &[u8]); 3] =
        [("model.obj", &[]), ("chess.gltf", &json), ("chess.bin", &buffer)];
    let with_picture =
        [&whole[..], &[("fretwork.png", &picture), ("bevelled.png", &normals)]].concat();
    let run = |files: &[(&str, &[u8])]| {
        let folder = folder(files);
        let mut command = sample();
        command.current_dir(&folder).args(["--validate", "--scene", "chess.gltf"]);
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, said) = run(&with_picture);
    assert_eq!((code, said.lines().count()), (Some(0), 4), "{said}");
    for line in [
        "has lights; this chapter has its own; 25_scene_effects shows them (2 in all)",
        "has a metalness and a roughness; this chapter shows a colour, a highlight or a mirror instead; 45_rough_metal shows them",
        "material \"board_light\" has a normal map; this chapter shows it smooth; 47_normal_maps shows it (2 in all)",
        "material \"fretwork\" has holes; this chapter shows it whole; 03_any_hit shows them (1 in all)",
    ] {
        assert!(said.contains(line), "{said}");
    }
    let (code, said) = run(&whole);
    let gone = "image 0: its URI names \"fretwork.png\", which is not there; the plain colour stands for it";
    assert!(code == Some(0) && said.contains(gone), "{said}");
    let gone = "image 1: its URI names \"bevelled.png\", which is not there; the surface is smooth";
    assert!(said.contains(gone), "{said}");
    let (code, said) = run(&[whole[1]]);
    let gone = "error: chess.gltf: nothing to show: a part of mesh \"board\" is left out: ";
    assert!(code == Some(1) && said.contains(gone) && said.lines().count() == 1, "{said}");
}

#[test]
fn objects_that_are_wrong() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (text, words) in [
        ("", "model.obj: has no faces"),
        ("o empty\nv 0 0 0\n", "model.obj: has no faces"),
        ("\u{1f}\u{8b} packed\n", "model.obj:1: "),
        ("solid cube\n", "model.obj:1: \"solid\" is not a keyword of an OBJ file"),
        ("v 0 0 0\nv nan 0 0\n", "model.obj:2: v has \"nan\", which is not a finite 32-bit number"),
        ("v 0 inf 0\n", "model.obj:1: v has \"inf\", which is not a finite 32-bit number"),
        ("v 0 -1e39 0\n", "model.obj:1: v has \"-1e39\", which is not a finite 32-bit number"),
        ("v 0 zero 0\n", "model.obj:1: v has \"zero\", which is not a number"),
        ("v 0 0\n", "model.obj:1: v has 2 numbers"),
        (
            "v 0 0 0\nv 1 0.",
            "model.obj:2: v has 2 numbers; x y z, x y z w or x y z r g b is right; the file ends \
             in this line, perhaps cut off",
        ),
    ] {
        files_refused(&[("model.obj", text.as_bytes())], &[words]);
    }
    for (face, words) in [
        ("f 1 2 4", "model.obj:4: face index 4 is out of range: the file has 3 positions"),
        ("f 1 2 0", "model.obj:4: face index 0 is out of range"),
        ("f 1 2 -4", "model.obj:4: face index -4 is out of range"),
        ("f 1 2 99999999999999999999", "model.obj:4: face index"),
        ("f 1 2", "model.obj:4: a face has 2 corners; it needs at least 3"),
        ("f a b c", "model.obj:4: face index \"a\" is not a whole number"),
    ] {
        files_refused(&[("model.obj", format!("{vertices}{face}\n").as_bytes())], &[words]);
    }
    let far = "v 0 0 3e38\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    files_refused(&[("model.obj", far.as_bytes())], &["model.obj: reaches 3e38 from the origin"]);
}

#[test]
fn files_that_are_not_there_or_no_files() {
    files_refused(&[], &["model.obj: there is no such file"]);
    let cannot_be_read = ["model.obj: is not a file that can be read, but a folder or a device"];
    files_refused(&[("model.obj/a", b"")], &cannot_be_read);
    let mut command = sample();
    command.args(["--scene", "no such folder/model.obj"]);
    refused_by(command, 1, &["no such folder/model.obj: there is no such file"]);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_keep_nobody_waiting() {
    let mut command = sample();
    command.args(["--scene", "/dev/zero"]);
    refused_by(command, 1, &["/dev/zero: is not a file that can be read"]);
    let (folder, command) = self::command(&[]);
    std::os::unix::fs::symlink("model.obj", folder.path().join("model.obj")).unwrap();
    refused_by(command, 1, &["model.obj: cannot be read: "]);
}

#[test]
fn materials_that_are_wrong() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    for (mtl, words) in [
        (
            "newmtl a\nKd red\n",
            "m.mtl:2: Kd has \"red\", which is not a number; the line is ignored",
        ),
        ("newmtl a\nKd nan 0 0\n", "m.mtl:2: Kd has \"nan\", which is not a finite 32-bit number"),
        ("newmtl a\nKd 1 1\n", "m.mtl:2: Kd has 2 numbers"),
        ("newmtl a\nd 2\n", "m.mtl:2: d is 2, and cannot be more than 1; 1 is taken"),
        ("newmtl a\nNs -1.96\n", "m.mtl:2: Ns is -1.96, and cannot be negative; 0 is taken"),
        ("newmtl a\nTr 1\n", "m.mtl:2: nothing is seen of a material with d 0 or Tr 1"),
        ("newmtl a\nilum 1\n", "m.mtl:2: \"ilum\" is not a keyword of an MTL file"),
        ("Kd 1 1 1\nnewmtl a\n", "m.mtl:1: Kd stands before the first newmtl"),
        (
            "newmtl a\nKd 0.5 0",
            "m.mtl:2: Kd has 2 numbers; a colour has 3, or 1 for a grey; the file ends in this line, perhaps cut off",
        ),
    ] {
        files_warned(&[("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())], &[words]);
    }
    let mtllib = format!("mtllib ../m.mtl\n{TRIANGLE}");
    let outside =
        ["model.obj:1: mtllib names \"../m.mtl\", outside the OBJ file's folder; copy it"];
    files_warned(&[("model.obj", mtllib.as_bytes())], &outside);
}

#[test]
fn textures_outside_the_folder_are_not_read() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    for name in ["../t.png", "/etc/passwd", "a/../../t.png", "C:\\t.png"] {
        let mtl = format!("newmtl a\nmap_d {name}\n");
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
        let line = format!(
            "m.mtl:2: map_d names {name:?}, outside the OBJ file's folder; copy it into the folder; \
             the plain colour stands for it (1 in all)"
        );
        files_warned(&files, &[&line]);
    }
}

/// Checks that the model is shown with these warnings; each line starts with the given words.
#[track_caller]
fn files_warned(files: &[(&str, &[u8])], lines: &[&str]) {
    let (_folder, mut command) = command(files);
    warned(&mut command, lines);
}

/// As [`files_warned`], for any sample.
#[track_caller]
fn warned(command: &mut std::process::Command, lines: &[&str]) {
    let output = command.arg("--validate").output().expect("the sample starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    assert_eq!(errors.lines().count(), lines.len(), "{errors}");
    for (actual, line) in errors.lines().zip(lines) {
        assert!(actual.starts_with(&format!("warning: {line}")), "'{line}' is not in: {errors}");
    }
}

#[test]
fn models_that_can_do_without() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (face, line) in [
        ("f 1/1 2 3", "model.obj:4: texture coordinate index 1 is out of range: the file has 0 "),
        (
            "f 1 2\nf 1 2 3",
            "model.obj:4: a face has 2 corners; it needs at least 3; the face is left out",
        ),
        ("v 0 nan 0\nf 1 2 4\nf 1 2 3", "model.obj:4: v has \"nan\", which is not a finite 32-bit"),
        ("vn nan 0 1\nf 1//1 2//1 3", "model.obj:4: vn has \"nan\", which is not a finite 32-bit"),
        ("f 1//1 2//2 3", "model.obj:4: normal index 1 is out of range: the file has 0 normals"),
        ("group a\nf 1 2 3", "model.obj:4: \"group\" is not a keyword of an OBJ file"),
    ] {
        files_warned(&[("model.obj", format!("{vertices}{face}\n").as_bytes())], &[line]);
    }
    // No material, no texture, and nothing a ray could hit.
    let unseen = "model.obj: none of its triangles has an area, and so nothing of it is seen";
    for face in ["f 1 2 2", "f 1 1 1", "v 3 0 0\nf 1 2 4"] {
        files_warned(&[("model.obj", format!("{vertices}{face}\n").as_bytes())], &[unseen]);
    }
    files_warned(&[("model.obj", format!("{vertices}f 1 2 2\nf 1 2 3\n").as_bytes())], &[]);
    // 25 reads models itself: a plain OBJ file, and one named by a scene file.
    let flat = format!("{vertices}f 1 2 2\n");
    let scene = "version = 1\nmodel = \"model.obj\"\n[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\n\
                 field_of_view = 40\n[[piece]]\nmesh = \"a\"\nat = [0, 0, 0]\n";
    for file in ["model.obj", "s.toml"] {
        let model = format!("o a\n{flat}");
        let folder = folder(&[("model.obj", model.as_bytes()), ("s.toml", scene.as_bytes())]);
        let mut command = run::command("25_scene_effects");
        command.current_dir(&folder).args(["--headless", "--size", "8x8", "--scene", file]);
        warned(&mut command, &[unseen]);
    }
    let obj = format!("mtllib m.mtl\nusemtl a\nvt 0 0\n{TRIANGLE}usemtl a\nf 1/1 2/1 3/1\n");
    let twice = "model.obj:2: the material \"a\" is not defined; the mtllib files hold";
    for (mtl, line) in [
        ("newmtl b\n", format!("{twice} \"b\"; a grey stands for it (2 in all)").as_str()),
        ("newmtl a\nmap_Kd gone.png\n", "m.mtl:2: map_Kd names \"gone.png\", which is not there"),
        ("newmtl a\nmap_Kd\n", "m.mtl:2: map_Kd is not followed by a name"),
        ("newmtl a\nmap_Kd -bm 0.2 t.png\n", "m.mtl:2: map_Kd has the option -bm, which is not"),
        ("newmtl a\nKd spectral a.rfl\n", "m.mtl:2: Kd has the form spectral, which is not"),
        ("newmtl a\nnewmtl a\n", "m.mtl:2: the material \"a\" is defined at m.mtl:1 already"),
    ] {
        let picture = picture();
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("t.png", &picture)];
        files_warned(&files, &[line]);
    }
    files_warned(
        &[("model.obj", obj.as_bytes())],
        &["model.obj:1: mtllib names \"m.mtl\", which is not there", twice],
    );
}

#[test]
fn textures_that_a_model_can_do_without() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let png = picture();
    let map = "newmtl a\nmap_Kd t.png\n";
    let warned = |texture: &[u8], line: &str| {
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", map.as_bytes()), ("t.png", texture)];
        files_warned(&files, &[line]);
    };
    let texture = "m.mtl:2: the texture t.png: ";
    warned(
        b"\xff\xd8\xff\xe0 a JPEG file",
        &format!("{texture}cannot be decoded, it is damaged or"),
    );
    warned(
        b"GIF89a",
        &format!("{texture}is a GIF file, which is not read; convert it to PNG or JPEG"),
    );
    warned(b"", &format!("{texture}is empty"));
    for cut in [20, png.len() / 2, png.len() - 20] {
        warned(&png[..cut], &format!("{texture}cannot be decoded, it is damaged or cut off"));
    }
}

/// A valid PNG file.
fn picture() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_fn(16, 16, |x, y| image::Rgba([x as u8, y as u8, 0, 255]));
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// As written by Blender: an object, names with a dot, texture coordinates, smoothing off.
const BLENDER: &str = "# Blender 4.1.1\n# www.blender.org\nmtllib model.mtl\no Cube.001\n\
    v 1.000000 1.000000 -1.000000\nv 1.000000 -1.000000 -1.000000\nv 1.000000 1.000000 1.000000\n\
    v 1.000000 -1.000000 1.000000\nvn 1.0000 -0.0000 -0.0000\nvt 0.625000 0.500000\n\
    vt 0.375000 0.500000\nvt 0.375000 0.750000\nvt 0.625000 0.750000\ns 0\nusemtl Material.001\n\
    f 1/1/1 3/4/1 4/3/1 2/2/1\n";
const BLENDER_MTL: &str = "# Blender 4.1.1 MTL File: 'None'\n# www.blender.org\n\n\
    newmtl Material.001\nNs 250.000000\nKa 1.000000 1.000000 1.000000\n\
    Kd 0.800000 0.300000 0.100000\nKs 0.500000 0.500000 0.500000\nKe 0.000000 0.000000 0.000000\n\
    Ni 1.450000\nd 1.000000\nillum 2\nPr 0.500000\nmap_Bump -bm 0.200000 bump.png\n";

/// As written by 3ds Max: CR LF, two spaces after `v`, counts in comments, groups, trailing spaces.
const MAX: &str = "# 3ds Max Wavefront OBJ Exporter v0.97b - (c)2007 guruware\r\n\
    # File Created: 12.03.2011 17:41:02\r\n\r\nmtllib model.mtl\r\n\r\n#\r\n# object Plane01\r\n\
    #\r\n\r\nv  -10.0000 0.0000 10.0000\r\nv  10.0000 0.0000 10.0000\r\n\
    v  -10.0000 0.0000 -10.0000\r\nv  10.0000 0.0000 -10.0000\r\n# 4 vertices\r\n\r\n\
    vn 0.0000 1.0000 -0.0000\r\n# 1 vertex normals\r\n\r\nvt 0.0000 0.0000 0.0000\r\n\
    vt 1.0000 0.0000 0.0000\r\nvt 0.0000 1.0000 0.0000\r\nvt 1.0000 1.0000 0.0000\r\n\
    # 4 texture coords\r\n\r\ng Plane01\r\nusemtl 01 - Default\r\ns 1\r\n\
    f 3/3/1 1/1/1 2/2/1 \r\nf 2/2/1 4/4/1 3/3/1 \r\n# 2 polygons\r\n\r\n";
const MAX_MTL: &str = "newmtl 01 - Default\r\n\tNs 10.0000\r\n\tNi 1.5000\r\n\td 1.0000\r\n\
    \tTr 0.0000\r\n\tTf 1.0000 1.0000 1.0000 \r\n\tillum 2\r\n\tKa 0.5880 0.5880 0.5880\r\n\
    \tKd 0.5880 0.5880 0.5880\r\n\tKs 0.0000 0.0000 0.0000\r\n\tKe 0.0000 0.0000 0.0000\r\n";

/// As written by MeshLab for a scan: colours after the positions, normals, `v//vn`.
const MESHLAB: &str = "####\n#\n# OBJ File Generated by Meshlab\n#\n####\n# Object scan.obj\n#\n\
    # Vertices: 4\n# Faces: 2\n#\n####\n\
    vn -0.577350 -0.577350 -0.577350\nv 0.000000 0.000000 0.000000 0.803922 0.764706 0.690196\n\
    vn 0.000000 0.000000 3.141593\nv 1.000000 0.000000 0.000000 0.803922 0.764706 0.690196\n\
    vn 0.000000 0.000000 3.141593\nv 0.000000 1.000000 0.000000 0.780392 0.745098 0.670588\n\
    vn 0.000000 0.000000 3.141593\nv 0.500000 0.500000 1e-3 0.780392 0.745098 0.670588\n\
    # 4 vertices, 0 vertices normals\n\nf 1//1 2//2 3//3\nf 2//2 4//4 3//3\n# 2 faces, 0 coords \
    texture\n\n# End of File\n";

/// As written by hand or exported from curves: indices counted from the end, a polygon of six corners over
/// several lines, and lines, points and free-form surfaces in addition.
const RELATIVE: &str = "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nvt 0 0\nvt 1 0\n\
    vt 1 0.5\nvt 1 1\nvt 0.5 1\nvt 0 1\nvn 0 0 1\ng outline hexagon\nf -6/-6/-1 -5/-5/-1 \\\n\
    -4/-4/-1 -3/-3/-1 \\\n  -2/-2/-1 -1/-1/-1\nl -6 -5 -4\np -1\ncstype rat bspline\ndeg 2\n\
    curv 0 1 -6 -5 -4\nparm u 0 0 0 1 1 1\nend\ncall other.obj\n";

#[test]
fn files_of_other_exporters() {
    for (name, obj, mtl, warnings) in [
        (
            "Blender",
            BLENDER,
            BLENDER_MTL,
            &[
                "model.mtl:14: map_Bump names \"bump.png\", which is not there; the surface is smooth",
                "model.obj: material \"Material.001\" has a metalness and a roughness",
            ][..],
        ),
        ("3ds Max", MAX, MAX_MTL, &[]),
        ("MeshLab", MESHLAB, "", &["model.obj:13: v has a colour"]),
        (
            "relative",
            RELATIVE,
            "",
            &[
                "model.obj:18: l is a line, which no ray can hit",
                "model.obj:19: p is a point, which no ray can hit",
                "model.obj:22: curv is a curve, which no ray can hit",
                "model.obj:25: \"call\" is not a keyword",
            ],
        ),
    ] {
        println!("{name}");
        let files = [("model.obj", obj.as_bytes()), ("model.mtl", mtl.as_bytes())];
        files_warned(&files, warnings);
    }
    let folder = format!("mtllib .\n{TRIANGLE}");
    let words = "model.obj:1: mtllib names \".\", which is a folder";
    files_warned(&[("model.obj", folder.as_bytes())], &[words]);
    let gone = "model.obj:3: mtllib names \"model.mtl\", which is not there";
    let grey = "model.obj:15: the material \"Material.001\" is not defined";
    files_warned(&[("model.obj", BLENDER.as_bytes())], &[gone, grey]);
}

#[test]
fn a_model_from_elsewhere_renders() {
    let textured = format!("mtllib a b.mtl\nusemtl a\nvt 0 0\n{TRIANGLE}f 1/1 2/1 3/1\n");
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    write("ein Ordner/象.obj", textured.as_bytes());
    write("ein Ordner/a b.mtl", b"newmtl a\nmap_Kd tex/t 1.png\n");
    write("ein Ordner/tex/t 1.png", &picture());
    for (current, scene) in [("", "ein Ordner/象.obj"), ("ein Ordner", "象.obj")] {
        let mut command = sample();
        command.current_dir(folder.path().join(current)).args(["--validate", "--scene", scene]);
        let output = command.output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && errors.is_empty(), "{scene}: {errors}");
    }
    let chess = run::root().join("samples/assets/chess.obj");
    let status = sample().current_dir(Path::new("/")).arg("--scene").arg(chess).status().unwrap();
    assert!(status.success());
}
