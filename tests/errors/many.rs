//! A model of many small parts needs no more Vulkan calls than one of few, so that no time, memory or device
//! limit depends on their number.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use run::layer::Layer;

use crate::limits::add_row;

/// A model of triangles side by side, each a mesh with a material and a texture of its own.
fn model(folder: &Path, count: usize) {
    let (mut obj, mut mtl) = (String::from("mtllib model.mtl\nvt 0 0\n"), String::new());
    let image = image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 150, 100, 255]));
    for i in 0..count {
        image.save(folder.join(format!("{i}.png"))).unwrap();
        writeln!(mtl, "newmtl m{i}\nmap_Kd {i}.png").unwrap();
        writeln!(obj, "v {i} 0 0\nv {i}.5 0 0\nv {i} 1 0\nusemtl m{i}\nf -3/1 -2/1 -1/1").unwrap();
    }
    fs::write(folder.join("model.obj"), obj).unwrap();
    fs::write(folder.join("model.mtl"), mtl).unwrap();
}

/// The number of calls of each function for a model of this many meshes and textures.
fn calls(count: usize) -> BTreeMap<String, usize> {
    let folder = tempfile::tempdir().unwrap();
    model(folder.path(), count);
    let told = folder.path().join("calls");
    let layer = Layer::fail_nth_call("");
    let mut command = layer.command("02_basic");
    command.args(["--headless", "--size", "8x8", "--scene"]).arg(folder.path().join("model.obj"));
    let output = command.env("CALLS", &told).output().expect("the sample starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Layer::calls(&told)
}

#[test]
fn many_meshes_and_textures_take_as_many_buffers_and_submissions_as_few() {
    let (few, many) = (calls(2), calls(1000));
    for function in ["vkCreateBuffer", "vkAllocateMemory", "vkQueueSubmit2", "vkCreateQueryPool"] {
        let (few, many) = (few[function], many[function]);
        // The number of bands of a picture depends on the time.
        assert!(many <= few + 8, "{function}: {few} calls for 2 meshes, {many} for 1,000");
    }
    // A check that the layer counts calls that depend on their number.
    assert!(many["vkCreateImage"] >= 1000, "{many:?}");
}

/// A scene with a given number of items, which is shown.
struct Shown {
    name: &'static str,
    chapter: &'static str,
    file: &'static str,
    write: fn(folder: &Path, count: usize),
}

/// The items of scene files are all in one place, where the boxes of an acceleration structure cannot
/// separate them.
const SHOWN: [Shown; 4] = [
    Shown {
        name: "triangles",
        chapter: "02_basic",
        file: "model.obj",
        write: |folder, count| {
            let row = |i| format!("v {i} 0 0\nv {i}.5 0 0\nv {i} 1 0\nf -3 -2 -1\n");
            fs::write(folder.join("model.obj"), (0..count).map(row).collect::<String>()).unwrap();
        },
    },
    Shown { name: "meshes and textures", chapter: "02_basic", file: "model.obj", write: model },
    Shown {
        name: "pieces",
        chapter: "25_scene_effects",
        file: "scene.toml",
        write: |folder, count| scene(folder, count, "[[piece]]\nmesh = \"pawn\"\nat = [0, 0, 0]\n"),
    },
    Shown {
        name: "spheres",
        chapter: "25_scene_effects",
        file: "scene.toml",
        write: |folder, count| {
            scene(folder, count, "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n")
        },
    },
];

/// A scene file that repeats this table.
fn scene(folder: &Path, count: usize, table: &str) {
    let head = "version = 1\n[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfield_of_view = 40\n\
                [[material]]\nname = \"a\"\n";
    fs::write(folder.join("scene.toml"), head.to_owned() + &table.repeat(count)).unwrap();
}

impl Shown {
    /// The seconds and the bytes needed for this many items, from the program's start to its end.
    fn spent(&self, count: usize) -> (f64, f64) {
        let folder = tempfile::tempdir().unwrap();
        (self.write)(folder.path(), count);
        let mut command = run::command(self.chapter);
        command.current_dir(&folder).args([
            "--headless",
            "--size",
            "8x8",
            "--scene",
            self.file,
            "--out",
            "a.png",
        ]);
        let spent = run::spend(&mut command);
        let errors = String::from_utf8_lossy(&spent.output.stderr);
        assert!(spent.output.status.success() && errors.is_empty(), "{errors}");
        println!("{} {}: {:?}, {} bytes", count, self.name, spent.time, spent.memory);
        (spent.time.as_secs_f64(), spent.memory as f64)
    }
}

#[test]
fn ten_times_as_many_of_anything_are_shown_in_ten_times_the_time() {
    for shown in SHOWN {
        let [least, few, many] = [1, 1000, 10_000].map(|count| shown.spent(count).0);
        let [few, many] = [few, many].map(|time| time - least);
        assert!(many < 20.0 * few.max(0.05), "{}: {few} s, then {many} s", shown.name);
    }
}

#[test]
#[ignore = "by hand: takes times"]
fn showing_grows_with_the_scene() {
    let mut table = serde_json::Map::new();
    for shown in SHOWN {
        add_row(&mut table, shown.name, |count| shown.spent(count));
    }
    run::expected::give_timed("limits/shown", table.into());
}
