//! Files that would take all the memory there is: refused, or shown without, before it is taken.

use std::fs;
use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const HEAD: &str =
    "version = 1\n[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfield_of_view = 40\n";

/// What a chapter says of the file `name` in this folder, and the most memory that it took, in bytes.
fn run(chapter: &str, folder: &TempDir, name: &str) -> (bool, String, u64) {
    let mut command = run::command(chapter);
    command.current_dir(folder).args(["--headless", "--size", "8x8", "--scene", name]);
    let (output, peak) = run::peak(&mut command);
    let line = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{peak} bytes: {line}");
    (output.status.success(), line, peak)
}

/// As [`run`], with what the chapter takes for a triangle taken off.
fn run_beyond(chapter: &str, folder: &TempDir, name: &str) -> (bool, String, u64) {
    let (success, line, peak) = run(chapter, folder, name);
    fs::write(folder.path().join("least.obj"), TRIANGLE).unwrap();
    let (_, _, least) = run(chapter, folder, "least.obj");
    (success, line, peak.saturating_sub(least))
}

fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// A PNG file of black texels, `bits` bits each, with a profile that unpacks to `profile` MiB of zeros.
fn png(side: u32, bits: u8, profile: usize) -> Vec<u8> {
    let packed = |start: &[u8], count: usize, bytes: usize| {
        let mut packed = ZlibEncoder::new(start.to_vec(), Compression::best());
        let zeros = vec![0; bytes];
        for _ in 0..count {
            packed.write_all(&zeros).unwrap();
        }
        packed.finish().unwrap()
    };
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        let content = [kind, data].concat();
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(&content);
        file.extend(crc32fast::hash(&content).to_be_bytes());
    };
    let size = [side.to_be_bytes(), side.to_be_bytes()].concat();
    chunk(b"IHDR", &[&size[..], &[bits, 0, 0, 0, 0]].concat());
    if profile > 0 {
        chunk(b"iCCP", &packed(b"p\0\0", profile, 1 << 20));
    }
    chunk(
        b"IDAT",
        &packed(b"", side as usize, 1 + (side as usize * usize::from(bits)).div_ceil(8)),
    );
    chunk(b"IEND", b"");
    file
}

fn with_texture(texture: &[u8]) -> TempDir {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let mtl: &[u8] = b"newmtl a\nmap_Kd t.png\n";
    folder(&[("model.obj", obj.as_bytes()), ("m.mtl", mtl), ("t.png", texture)])
}

#[test]
fn a_model_of_too_many_triangles_is_refused_before_it_takes_the_memory() {
    let polygon = format!("f{}\n", " 1".repeat(1000));
    let obj = format!("{TRIANGLE}{}", polygon.repeat(22_000));
    let folder = folder(&[("model.obj", obj.as_bytes())]);
    drop(obj);
    let (success, line, peak) = run_beyond("02_basic", &folder, "model.obj");
    let words = "error: model.obj: would take up to 4.2 GB of memory with its 22000003 corners of 22001 \
                 faces, 3 positions and 0 meshes; at most 4.0 GB are taken\n";
    assert!(!success && line == words, "{line}");
    // The file, and what was written of it until then.
    assert!(peak < 44_000_000 * 6, "{peak}");
}

#[test]
fn a_small_picture_of_many_texels_is_not_unpacked() {
    let texture = png(16384, 1, 0);
    assert!(texture.len() < 40_000, "{}", texture.len());
    let (success, line, peak) = run_beyond("02_basic", &with_texture(&texture), "model.obj");
    let words = "m.mtl:2: the texture t.png: is 16384 x 16384 texels, which take 1342177280 bytes to \
                 decode; all textures together may take 536870912, of which 536870912 are left; the plain";
    assert!(success && line.contains(words), "{line}");
    assert!(peak < 32 << 20, "{peak}");
}

#[test]
fn a_profile_of_gigabytes_is_not_unpacked() {
    let texture = png(16, 8, 512);
    let (success, line, peak) = run_beyond("02_basic", &with_texture(&texture), "model.obj");
    assert!(success && line.is_empty(), "{line}");
    assert!(peak < 64 << 20, "{peak}");
}

#[test]
fn a_scene_file_of_many_keys_is_refused_before_it_takes_the_memory() {
    let keys = |i: usize| format!("k{i}.{}a = 1\n", "a.".repeat(70));
    let text: String = (0..14_000).map(keys).collect();
    let folder = folder(&[("scene.toml", text.as_bytes())]);
    let (success, line, peak) = run_beyond("25_scene_effects", &folder, "scene.toml");
    let words = "error: scene.toml: would take up to ";
    assert!(!success && line.starts_with(words), "{line}");
    assert!(line.ends_with(" keys and 0 lists; at most 0.8 GB are taken\n"), "{line}");
    assert!(peak < 100 << 20, "{peak}");
}

#[test]
fn a_large_mesh_that_shines_in_many_places_is_refused_before_they_are_listed() {
    let piece = "[[piece]]\nmesh = \"queen\"\nat = [0, 0, 0]\nmaterial = \"lamp\"\n";
    let paint = "[[material]]\nname = \"lamp\"\nemission = [1, 1, 1]\n";
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"lamp\"\n";
    let text = format!("{HEAD}{paint}{ball}{}", piece.repeat(10_000));
    let folder = folder(&[("scene.toml", text.as_bytes())]);
    let (success, line, peak) = run_beyond("25_scene_effects", &folder, "scene.toml");
    let words = " triangles and spheres shine, and at most 1048576 may\n";
    assert!(!success && line.ends_with(words), "{line}");
    assert!(peak < 200 << 20, "{peak}");
}

/// The time that a chapter takes for files of 1 and of 10 times a size.
fn times(chapter: &str, make: impl Fn(usize) -> String, name: &str, count: usize) -> [f64; 2] {
    [count, 10 * count].map(|count| {
        let folder = folder(&[(name, make(count).as_bytes())]);
        let start = std::time::Instant::now();
        let (_, line, _) = run(chapter, &folder, name);
        assert!(line.starts_with("error: "), "{line}");
        start.elapsed().as_secs_f64()
    })
}

#[test]
fn meshes_and_pieces_are_read_in_time_that_grows_as_they_do() {
    // Wrong at its end: only the reading is timed.
    let meshes = |count: usize| format!("{TRIANGLE}{}f 0 0 0\n", "o\nf 1 2 3\n".repeat(count));
    let [few, many] = times("02_basic", meshes, "model.obj", 10_000);
    assert!(many < 15.0 * few.max(0.3), "{few} {many}");
    let piece = "[[piece]]\nmesh = \"pawn\"\nat = [0, 0, 0]\n";
    let wrong = "[[piece]]\nmesh = \"none\"\nat = [0, 0, 0]\n";
    let pieces = |count: usize| format!("{HEAD}{}{wrong}", piece.repeat(count - 1));
    let [few, many] = times("25_scene_effects", pieces, "scene.toml", 10_000);
    assert!(many < 15.0 * few.max(0.3), "{few} {many}");
}
