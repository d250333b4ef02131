//! `--scene`: whatever is wrong with a model is refused with file and line.

use std::fs;
use std::path::Path;

use crate::{refused_by, sample};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Writes files into a new folder and renders `model.obj` with the folder as the current one.
fn command(files: &[(&str, &[u8])]) -> (tempfile::TempDir, std::process::Command) {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let mut command = sample();
    command.current_dir(&folder).args(["--scene", "model.obj"]);
    (folder, command)
}

#[track_caller]
fn files_refused(files: &[(&str, &[u8])], words: &[&str]) {
    let (_folder, command) = command(files);
    refused_by(command, 1, words);
}

#[test]
fn objects_that_are_wrong() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (text, words) in [
        ("", "model.obj: has no faces"),
        ("o empty\nv 0 0 0\n", "model.obj: has no faces"),
        ("\u{1f}\u{8b} packed\n", "model.obj:1: "),
        ("solid cube\n", "model.obj:1: \"solid\" is not a keyword of an OBJ file"),
        ("v 0 0 0\nv nan 0 0\n", "model.obj:2: \"nan\" is not a finite 32-bit number"),
        ("v 0 inf 0\n", "model.obj:1: \"inf\" is not a finite 32-bit number"),
        ("v 0 -1e39 0\n", "model.obj:1: \"-1e39\" is not a finite 32-bit number"),
        ("v 0 zero 0\n", "model.obj:1: \"zero\" is not a number"),
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
        ("f 1/1 2 3", "model.obj:4: texture coordinate index 1 is out of range"),
        ("f 1//1 2 3", "model.obj:4: normal index 1 is out of range"),
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
        ("newmtl a\nKd red\n", "m.mtl:2: \"red\" is not a number"),
        ("newmtl a\nKd nan 0 0\n", "m.mtl:2: \"nan\" is not a finite 32-bit number"),
        ("newmtl a\nKd 1 1\n", "m.mtl:2: Kd has 2 numbers"),
        ("newmtl a\nd 2\n", "m.mtl:2: d is 2; it cannot be more than 1"),
        ("Kd 1 1 1\n", "m.mtl:1: Kd stands before the first newmtl"),
        ("newmtl b\n", "model.obj:2: the material \"a\" is not defined"),
        ("newmtl a\nmap_Kd gone.png\n", "m.mtl:2: map_Kd names \"gone.png\", which is not there"),
        (
            "newmtl a\nKd 0.5 0",
            "m.mtl:2: Kd has 2 numbers; a colour has 3, or 1 for a grey; the file ends in this line, perhaps cut off",
        ),
    ] {
        files_refused(&[("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())], &[words]);
    }
    files_refused(
        &[("model.obj", obj.as_bytes())],
        &["model.obj:1: mtllib names \"m.mtl\", which"],
    );
    let mtllib = "mtllib ../m.mtl\n";
    let outside = ["model.obj:1: mtllib names \"../m.mtl\", outside the OBJ file's folder"];
    files_refused(&[("model.obj", mtllib.as_bytes())], &outside);
}

#[test]
fn textures_that_are_wrong() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let png = picture();
    let files = |mtl: &'static str, texture: &[u8], words: &str| {
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("t.png", texture)];
        files_refused(&files, &[words]);
    };
    let map = "newmtl a\nmap_Kd t.png\n";
    let texture = "m.mtl:2: the texture t.png: ";
    files(map, b"\xff\xd8\xff\xe0 a JPEG file", &format!("{texture}is not a PNG file"));
    files(map, b"", &format!("{texture}is not a PNG file"));
    for cut in [20, png.len() / 2, png.len() - 20] {
        files(map, &png[..cut], &format!("{texture}cannot be decoded, it is damaged or cut off"));
    }
    for name in ["../t.png", "/etc/passwd", "a/../../t.png", "C:\\t.png"] {
        let mtl = format!("newmtl a\nmap_d {name}\n");
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
        files_refused(&files, &["m.mtl:2: map_d names ", "outside the OBJ file's folder"]);
    }
}

/// A PNG file that is sound.
fn picture() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_fn(16, 16, |x, y| image::Rgba([x as u8, y as u8, 0, 255]));
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn a_model_from_elsewhere_renders() {
    let textured = format!("mtllib a b.mtl\nusemtl a\n{TRIANGLE}");
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    write("ein Ordner/象.obj", textured.as_bytes());
    write("ein Ordner/a b.mtl", b"newmtl a\nmap_Kd tex/t 1.png\n");
    write("ein Ordner/tex/t 1.png", &picture());
    // No material, no texture, and nothing that a ray could meet.
    write("ein Ordner/point.obj", b"v 0 0 0\nf 1 1 1\n");
    for (current, scene) in
        [("", "ein Ordner/象.obj"), ("ein Ordner", "象.obj"), ("", "ein Ordner/point.obj")]
    {
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
