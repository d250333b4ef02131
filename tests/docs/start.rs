//! A reader's own crate, made by the tool: complete, and pinned to the versions the book is tested with. A
//! nightly test of `tests/window` builds and runs it; the template has a test of its own for the picture.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use common::app::Picture;
use common::prelude::{Camera, DVec3, Sun, Vec3};

use crate::fixture::{Outcome, run};

fn start(arguments: &[&str], folder: &Path) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_chapters"));
    run(command.arg("start").args(arguments).arg(folder))
}

fn table(file: &Path) -> toml::Table {
    fs::read_to_string(file).expect("a file").parse().expect("it is TOML")
}

/// The packages of a lock file: name, version and source of each.
fn locked(file: &Path) -> BTreeSet<[String; 3]> {
    let lock = table(file);
    let text = |package: &toml::Value, key: &str| {
        package.get(key).map_or(String::new(), |value| value.as_str().expect("text").to_owned())
    };
    let packages = lock["package"].as_array().expect("packages").iter();
    packages.map(|package| ["name", "version", "source"].map(|key| text(package, key))).collect()
}

#[test]
fn a_crate_of_one_s_own_is_whole_and_pinned() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("deep/glow");
    let outcome = start(&[], &folder);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    for line in [
        ".cargo/config.toml",
        "src/main.rs",
        "shaders/glow/camera.rgen",
        "tests/picture.rs",
        "cargo run",
    ] {
        assert!(outcome.out.lines().any(|told| told == line), "{}", outcome.out);
    }
    for file in outcome.out.lines().take_while(|line| !line.is_empty()) {
        let text = fs::read_to_string(folder.join(file)).expect("what is told is there");
        assert!(file == "Cargo.lock" || !text.contains("my_tracer"), "{file}");
    }
    // Cargo takes all versions from the lock file, without asking a registry.
    let cargo = Command::new(env!("CARGO"))
        .args(["update", "--workspace", "--offline", "--quiet"])
        .current_dir(&folder)
        .output()
        .expect("cargo starts");
    assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
    let (own, book) =
        (locked(&folder.join("Cargo.lock")), locked(&::run::root().join("Cargo.lock")));
    let new: Vec<_> = own.difference(&book).map(|[name, ..]| name.as_str()).collect();
    assert_eq!(new, ["glow"]);
    // The crate uses the results of the book's build, with the same C++ compiler.
    let settings = table(&folder.join(".cargo/config.toml"));
    let target = Path::new(env!("CARGO_BIN_EXE_chapters")).ancestors().nth(2).expect("a folder");
    let shared = settings["build"]["build-dir"].as_str().expect("a path");
    assert_eq!(Path::new(shared), target.canonicalize().expect("the book's target"));
    let book = table(&::run::root().join(".cargo/config.toml"));
    for (name, setting) in book["env"].as_table().expect("variables") {
        let value = ::run::root().join(setting["value"].as_str().expect("a path"));
        assert!(value.is_file(), "{}", value.display());
        let own = Path::new(settings["env"][name].as_str().expect("a path"));
        assert_eq!(own, value.canonicalize().expect("a file"));
    }
    // Everything the profile names exists; otherwise Cargo would warn.
    let manifest = table(&folder.join("Cargo.toml"));
    let profile = &manifest["profile"]["dev"];
    assert_eq!(*profile, {
        let mut whole = table(&::run::root().join("Cargo.toml"))["profile"]["dev"].clone();
        let packages = whole["package"].as_table_mut().expect("packages");
        packages.retain(|name, _| name == "*" || own.iter().any(|[of, ..]| of == name));
        whole
    });
    assert_eq!(profile["package"]["raybook"]["opt-level"].as_integer(), Some(2));
}

#[test]
fn the_framework_may_come_from_a_git_repository() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("glow");
    // An existing empty folder is accepted and kept.
    fs::create_dir(&folder).expect("a folder");
    let outcome = start(&["--git", "https://example.org/a\"b"], &folder);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let manifest = table(&folder.join("Cargo.toml"));
    let dependency = &manifest["dependencies"]["raybook"];
    assert_eq!(dependency["git"].as_str(), Some("https://example.org/a\"b"));
    assert!(dependency.get("path").is_none());
    assert!(!folder.join(".cargo").exists(), "another version may be compiled otherwise");
}

#[test]
fn a_crate_may_be_built_apart() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("glow");
    let outcome = start(&["--apart"], &folder);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(!outcome.out.contains("config.toml") && !folder.join(".cargo").exists());
}

/// The files of the template become the reader's own: they mention no chapter, and have no marks for pages.
#[test]
fn a_crate_of_one_s_own_speaks_of_no_chapter() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("glow");
    let outcome = start(&[], &folder);
    for file in outcome.out.lines().take_while(|line| !line.is_empty()) {
        let text = fs::read_to_string(folder.join(file)).expect("what is told is there");
        for word in ["ANCHOR", "chapter", "Taught by"] {
            // The lock file lists the book's own crates until Cargo drops them.
            assert!(file == "Cargo.lock" || !text.contains(word), "{file}: {word}");
        }
    }
    let help = run(::run::command("my_tracer").arg("--help"));
    assert_eq!(help.code, 0, "{}", help.err);
    for word in ["chapter", "14", "23", "25", ".legs"] {
        assert!(!help.out.contains(word), "{word}: {}", help.out);
    }
    let scenes = "25 also scene files (.toml)";
    assert!(run(::run::command("02_basic").arg("--help")).out.contains(scenes));
}

#[test]
fn frames_of_a_program_of_one_s_own_make_an_animation() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("a.png");
    let mut program = ::run::command("my_tracer");
    program.args(["--headless", "--size", "16x10", "--animate", "--frames", "3", "--out"]);
    let outcome = run(program.arg(&out));
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let still = "all frames are the same; what moves follows frame.index or a Playback\n";
    assert!(
        outcome.err.starts_with("warning: ") && outcome.err.ends_with(still),
        "{}",
        outcome.err
    );
    assert!(fs::read(&out).expect("a file").windows(4).any(|part| part == b"acTL"));
}

/// The texture named by `map_Kd` is sampled at the hit.
#[test]
fn a_texture_of_one_s_own_model_is_shown() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| folder.path().join(name);
    let model = "mtllib floor.mtl\nusemtl floor\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\n\
                 vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    fs::write(file("floor.obj"), model).expect("a model");
    let seen = |material: &str| {
        fs::write(file("floor.mtl"), material).expect("a material");
        let mut program = ::run::command("my_tracer");
        program.args(["--headless", "--validate", "--size", "1x1", "--scene"]);
        program.arg(file("floor.obj")).args(["--set", "camera eye=-2,3,-2"]);
        program.args(["--set", "camera target=-2,0,-2.1", "--out"]).arg(file("out.exr"));
        let outcome = run(&mut program);
        assert_eq!((outcome.code, &*outcome.err), (0, ""));
        let [red, green, blue, _] =
            Picture::open_exr(&file("out.exr")).expect("a picture").pixels[0];
        Vec3::new(red, green, blue)
    };
    // Left half red, right half green; the point is on the left.
    let half = |x: u32, _| image::Rgb(if x < 32 { [255u8, 0, 0] } else { [0, 255, 0] });
    image::RgbImage::from_fn(64, 64, half).save(file("halves.png")).expect("a texture");
    let plain = seen("newmtl floor\nKd 1 1 1\n");
    let red = seen("newmtl floor\nKd 1 1 1\nmap_Kd halves.png\n");
    assert!(plain.min_element() > 0.1, "{plain}");
    assert!(red.abs_diff_eq(plain * Vec3::X, 1e-5), "{red} instead of {}", plain * Vec3::X);
}

/// The program after some steps of the page, on its own grey ground.
struct Stepped {
    name: &'static str,
    folder: tempfile::TempDir,
}

impl Stepped {
    fn new(name: &'static str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let ground = "v -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nf 1 2 3 4\n";
        fs::write(folder.path().join("ground.obj"), ground).expect("a scene");
        Self { name, folder }
    }

    /// Overwrites the shaders these steps change.
    fn with(self, steps: &[&str]) -> Self {
        for step in steps {
            let own = ::run::root().join("docs/chapters/start").join(step).join("shaders");
            ::run::copy(&own, self.folder.path());
        }
        self
    }

    fn pixels(&self, size: &str, settings: &[&str]) -> Vec<Vec3> {
        let out = self.folder.path().join("out.exr");
        let settings = settings.iter().flat_map(|setting| ["--set", setting]);
        let outcome = run(::run::command(self.name)
            .env("SHADERS", self.folder.path())
            .args(["--headless", "--validate", "--size", size, "--scene"])
            .arg(self.folder.path().join("ground.obj"))
            .args(settings)
            .arg("--out")
            .arg(&out));
        assert_eq!((outcome.code, &*outcome.err), (0, ""));
        let picture = Picture::open_exr(&out).expect("a picture");
        picture.pixels.iter().map(|[red, green, blue, _]| Vec3::new(*red, *green, *blue)).collect()
    }
}

#[test]
fn the_moon_of_the_page_lights_the_ground() {
    let program = Stepped::new("my_tracer_second_light").with(&["template", "second_light"]);
    let at = |moon| {
        let eye = ["camera eye=0,3,1", "camera target=0,0,0"];
        program.pixels("1x1", &[&[moon], &eye[..]].concat())[0]
    };
    let height = 0.8 / Vec3::new(1.0, 0.8, 0.4).length();
    let light = 0.5 * 2.0 * Vec3::new(0.2, 0.4, 0.8) * height / std::f32::consts::PI;
    let added = at("moon=2") - at("moon=0");
    assert!(added.abs_diff_eq(light, 1e-5), "{added} instead of {light}");
}

#[test]
fn a_lamp_of_the_page_lights_the_ground() {
    let steps = ["template", "second_light", "sphere", "bowl", "lamps"];
    let program = Stepped::new("my_tracer_lamps").with(&steps);
    let at = |lamps| {
        let eye = ["camera eye=-0.5,3,1.9", "camera target=-0.5,0,1.8999"];
        program.pixels("1x1", &[&[lamps], &eye[..]].concat())[0]
    };
    // The first lamp is at (0, 0.35, 1.9).
    let way = Vec3::new(0.5, 0.35, 0.0);
    let arriving = Vec3::new(0.0, 0.04, 0.15) / way.length_squared() * (0.35 / way.length());
    let light = 0.5 * arriving / std::f32::consts::PI;
    let added = at("lamps=1") - at("lamps=0");
    assert!(added.abs_diff_eq(light, 1e-4), "{added} instead of {light}");
}

#[test]
fn a_grid_of_rays_is_the_mean_of_a_finer_picture() {
    let steps = ["template", "second_light", "sphere", "bowl", "lamps", "smooth"];
    let program = Stepped::new("my_tracer_smooth").with(&steps);
    let (coarse, fine) =
        (program.pixels("30x20", &["grid=4"]), program.pixels("120x80", &["grid=1"]));
    let mean = |i: usize| {
        let (x, y) = (i % 30, i / 30);
        let of = |j: usize| fine[(4 * y + j / 4) * 120 + 4 * x + j % 4];
        (0..16).map(of).sum::<Vec3>() / 16.0
    };
    // A ray along an edge may fall on either side of it in the other picture.
    let is_other = |i: &usize| !coarse[*i].abs_diff_eq(mean(*i), 1e-4);
    let others = (0..coarse.len()).filter(is_other).count();
    assert!(others <= 6, "{others} of 600 pixels differ");
}

#[test]
fn the_sphere_of_the_page_is_lit_as_a_sphere_and_the_bowl_is_its_lower_half() {
    let steps = ["template", "second_light", "sphere"];
    let program = Stepped::new("my_tracer_sphere").with(&steps);
    let settings = [
        "camera eye=0.9,0.6,6",
        "camera target=0.9,0.6,0.9",
        "field of view=20",
        "sun azimuth=30",
        "sun elevation=30",
        "moon=0",
    ];
    let (center, radius) = (DVec3::new(0.9, 0.6, 0.9), 0.6);
    let camera = Camera::new(DVec3::new(0.9, 0.6, 6.0), center, 20.0);
    let sun = Sun { azimuth: 30.0, elevation: 30.0, ..Sun::default() }.light();
    let [right, up, forward] = camera.axes();
    let half = (camera.fov_y / 2.0).to_radians().tan();
    let (low, high) = (Vec3::new(0.16, 0.14, 0.12), Vec3::new(0.42, 0.47, 0.55));
    let sphere = program.pixels("60x60", &settings);
    // The direction from the sphere's center to the point in each pixel, for pixels of the sphere that are
    // not near its outline.
    let outward = |i: usize| {
        let [x, y] = [i % 60, 59 - i / 60].map(|i| (2.0 * i as f64 + 1.0) / 60.0 - 1.0);
        let ray = (forward + half * (x * right + y * up)).normalize();
        let (f, b) = (camera.eye - center, (camera.eye - center).dot(ray));
        let discriminant = b * b - f.length_squared() + radius * radius;
        (discriminant > 0.01).then(|| ((f - (b + discriminant.sqrt()) * ray) / radius).as_vec3())
    };
    let mut lit = 0;
    for (i, color) in sphere.iter().enumerate() {
        let Some(normal) = outward(i) else { continue };
        let cosine = normal.dot(sun.direction);
        let sky = low.lerp(high, 0.5 + 0.5 * normal.y);
        let exact = 0.5 * (sky + sun.radiance * cosine.max(0.0) / std::f32::consts::PI);
        assert!(color.abs_diff_eq(exact, 1e-4), "pixel {i}: {color} instead of {exact}");
        lit += usize::from(cosine > 0.0);
    }
    assert!(lit > 500, "{lit} pixels in the sun");
    let bowl = program.with(&["bowl"]).pixels("60x60", &settings);
    for (i, (bowl, sphere)) in bowl.iter().zip(&sphere).enumerate() {
        if let Some(normal) = outward(i).filter(|normal| normal.y.abs() > 0.05) {
            assert_eq!(bowl == sphere, normal.y < 0.0, "pixel {i}");
        }
    }
}

#[test]
fn a_crate_that_cannot_be_is_refused_and_nothing_is_written() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let used = above.path().join("used");
    fs::create_dir(&used).expect("a folder");
    fs::write(used.join("notes"), "mine").expect("a file");
    for (folder, words) in [
        (used.clone(), "is not empty; name a folder that is empty or new"),
        (used.join("notes"), "is no folder; name one that is empty or new"),
        (above.path().join("Glow"), "a letter from a to z, then a to z, 0 to 9 and _"),
        (above.path().join("9glow"), "a letter from a to z, then a to z, 0 to 9 and _"),
        (above.path().join("glow-worm"), "a letter from a to z, then a to z, 0 to 9 and _"),
        (above.path().join("match"), "ends in a name that Rust, Cargo or the book keeps"),
        (above.path().join("raybook"), "ends in a name that Rust, Cargo or the book keeps"),
        (::run::root().join("docs/glow"), "lies in the book; name a folder outside"),
        (used.join("../../").join(::run::root()).join("samples/../glow"), "lies in the book"),
    ] {
        let outcome = start(&[], &folder);
        assert_eq!((outcome.code, &*outcome.out), (2, ""), "{folder:?}: {}", outcome.err);
        assert!(outcome.err.contains(words), "{folder:?}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    // The folder's parent is a file.
    let outcome = start(&[], &used.join("notes/glow"));
    assert_eq!((outcome.code, &*outcome.out), (1, ""), "{}", outcome.err);
    let names = |folder: &Path| -> Vec<_> {
        folder
            .read_dir()
            .expect("a folder")
            .map(|entry| entry.expect("an entry").file_name())
            .collect()
    };
    assert_eq!((names(above.path()), names(&used)), (vec!["used".into()], vec!["notes".into()]));
    assert!(!::run::root().join("glow").exists() && !::run::root().join("docs/glow").exists());
}
