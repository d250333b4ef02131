//! Files that would exhaust memory: refused, or shown without the offending part, before it is allocated.

use std::fs;
use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};
use run::Spent;
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const HEAD: &str =
    "version = 1\n[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfield_of_view = 40\n";

/// Runs a chapter with the file `name` of this folder as its scene; returns its messages and its memory.
fn run(chapter: &str, folder: &TempDir, name: &str) -> (String, Spent) {
    let mut command = run::command(chapter);
    command.current_dir(folder).args(["--headless", "--size", "8x8", "--scene", name]);
    command.args(["--out", "a.png"]);
    let spent = run::spend(&mut command);
    let line = String::from_utf8_lossy(&spent.output.stderr).into_owned();
    println!("{} bytes, {:?}: {line}", spent.memory, spent.time);
    (line, spent)
}

/// As [`run`], with the bytes it needs beyond those of a single triangle.
fn run_beyond(chapter: &str, folder: &TempDir, name: &str) -> (bool, String, u64) {
    let (line, spent) = run(chapter, folder, name);
    fs::write(folder.path().join("least.obj"), TRIANGLE).unwrap();
    let (_, least) = run(chapter, folder, "least.obj");
    (spent.output.status.success(), line, spent.memory.saturating_sub(least.memory))
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
    let obj = format!("mtllib m.mtl\nusemtl a\nvt 0 0\n{TRIANGLE}f 1/1 2/1 3/1\n");
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
    let words = "error: model.obj: would take up to 13.7 GB of memory with its 22000003 corners of 22001 \
                 faces, 3 positions and 1 meshes; at most 4.0 GB are taken\n";
    assert!(!success && line == words, "{line}");
    // The file, and its triangles up to the limit, in a list that grows by doubling.
    assert!(peak < 44_000_000 + 2 * 40 * 6_500_000, "{peak}");
}

/// Polygons give the most triangles per byte, and their corners share no vertices.
#[test]
fn a_model_takes_no_more_memory_than_was_counted() {
    let polygon = format!("f{}\n", " 1 2 3 2".repeat(250));
    let triangles = 500 * 998;
    let obj = format!("{TRIANGLE}{}", polygon.repeat(500));
    let (_, line, peak) =
        run_beyond("02_basic", &folder(&[("model.obj", obj.as_bytes())]), "model.obj");
    assert!(line.is_empty(), "{line}");
    let counted = 5 * obj.len() as u64 + (108 + 512) * triangles;
    assert!(peak < counted, "{peak} of {counted}");
    // Memory on a GPU is not part of the process.
    assert!(counted / 2 < peak || !run::device::is_software(), "{peak} of {counted}");
}

#[test]
fn a_small_picture_of_many_texels_is_not_unpacked() {
    let texture = png(16384, 1, 0);
    assert!(texture.len() < 40_000, "{}", texture.len());
    let (success, line, peak) = run_beyond("02_basic", &with_texture(&texture), "model.obj");
    let words = "m.mtl:2: the texture t.png: is 16384 x 16384 texels, which take 1343 MB to decode; \
                 all textures together may take 537 MB, of which 537 MB are left; the plain";
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
    let text =
        format!("{HEAD}{paint}{}{}", BALL.replace("\"a\"", "\"lamp\""), piece.repeat(10_000));
    let folder = folder(&[("scene.toml", text.as_bytes())]);
    let (success, line, peak) = run_beyond("25_scene_effects", &folder, "scene.toml");
    let words = " triangles and spheres shine, and at most 1048576 may\n";
    assert!(!success && line.ends_with(words), "{line}");
    assert!(peak < 200 << 20, "{peak}");
}

/// A model that is only refused after it has been read completely.
const FAR: &str = "v 0 0 1e30\nf 1 2 -1\n";
const QUEEN: &str = "[[piece]]\nmesh = \"queen\"\nat = [0, 0, 0]\n";
const BALL: &str = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";

/// A scene or a model with a given number of items, which is read to its end and then refused.
struct Grown {
    name: &'static str,
    chapter: &'static str,
    file: &'static str,
    text: fn(usize) -> String,
}

const GROWN: [Grown; 6] = [
    Grown {
        name: "triangles",
        chapter: "02_basic",
        file: "model.obj",
        text: |count| format!("{TRIANGLE}{}{FAR}", "f 1 2 3\n".repeat(count)),
    },
    Grown {
        name: "meshes",
        chapter: "02_basic",
        file: "model.obj",
        text: |count| format!("{TRIANGLE}{}{FAR}", "o\nf 1 2 3\n".repeat(count)),
    },
    Grown {
        name: "materials",
        chapter: "02_basic",
        file: "model.obj",
        text: |count| {
            let uses = |i| format!("usemtl {i}\nf 1 2 3\n");
            format!("{TRIANGLE}{}{FAR}", (0..count).map(uses).collect::<String>())
        },
    },
    Grown {
        name: "spheres",
        chapter: "25_scene_effects",
        file: "scene.toml",
        text: |count| format!("{HEAD}[[material]]\nname = \"b\"\n{}", BALL.repeat(count)),
    },
    Grown {
        name: "pieces",
        chapter: "25_scene_effects",
        file: "scene.toml",
        text: |count| {
            format!("{HEAD}{}{}", QUEEN.repeat(count - 1), QUEEN.replace("queen", "none"))
        },
    },
    Grown {
        name: "keys",
        chapter: "25_scene_effects",
        file: "scene.toml",
        text: |count| (0..count).map(|i| format!("k{i} = 1\n")).collect(),
    },
];

impl Grown {
    /// The seconds and the bytes needed for this many items.
    fn spent(&self, count: usize) -> (f64, f64) {
        let folder = folder(&[(self.file, (self.text)(count).as_bytes())]);
        let (line, spent) = run(self.chapter, &folder, self.file);
        assert!(line.starts_with("error: ") && !line.contains("would take"), "{line}");
        (spent.time.as_secs_f64(), spent.memory as f64)
    }
}

#[test]
fn ten_times_as_many_of_anything_are_read_in_ten_times_the_time() {
    for grown in GROWN {
        let [least, few, many] = [1, 10_000, 100_000].map(|count| grown.spent(count).0);
        // A tenth of a second may be noise; comparing each item with each would take a hundred times as long.
        let [few, many] = [few, many].map(|time| time - least);
        assert!(many < 20.0 * few.max(0.1), "{}: {few} s, then {many} s", grown.name);
    }
}

#[test]
#[ignore = "by hand: takes times"]
fn reading_grows_with_the_file() {
    let mut table = serde_json::Map::new();
    for grown in GROWN {
        add_row(&mut table, grown.name, |count| grown.spent(count));
    }
    run::expected::give_timed("limits/growth", table.into());
}

/// Adds a row with the milliseconds and megabytes for 1,000 to 100,000 items, minus those for one; `spent`
/// returns seconds and bytes.
pub fn add_row(
    table: &mut serde_json::Map<String, serde_json::Value>,
    name: &str,
    spent: impl Fn(usize) -> (f64, f64),
) {
    // The first run may compile shaders that later ones find in the driver's cache.
    spent(1);
    let (name, least) = (name.replace(' ', "-"), spent(1));
    for count in [1000, 10_000, 100_000] {
        let (time, bytes) = spent(count);
        let (time, bytes) = ((time - least.0).max(0.0), (bytes - least.1).max(0.0));
        table.insert(format!("{name}.time_{count}"), (1e3 * time).into());
        table.insert(format!("{name}.memory_{count}"), (1e-6 * bytes).into());
    }
}
