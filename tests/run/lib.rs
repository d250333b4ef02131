//! Runs samples like their users, one process per run, and compares pictures.

#[cfg(target_os = "linux")]
pub mod cards;
mod chapter;
pub mod equality;
pub mod expected;
pub mod failures;
pub mod layer;
pub mod leaving;
pub mod plot;
pub mod primary_hits;
#[cfg(target_os = "linux")]
mod spent;
#[cfg(unix)]
mod tally;
mod validated;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{LazyLock, Mutex, PoisonError};

pub use chapter::{Chapter, set_arguments};
use common::app::Picture;
use common::gpu::{Gpu, GpuOptions, Requirements};
pub use device;
pub use equality::{Near, same_answers, same_colors, same_hits};
pub use flip::near::pictures as flip;
use serde_json::Value;
#[cfg(target_os = "linux")]
pub use spent::{Spent, spend};

/// The results of a run of a sample.
pub struct Run {
    /// The last frame, as the floats written by the shader.
    pub picture: Picture,
    /// The report.
    pub report: Value,
}

/// The messages of a program that has panicked, crashed or run out of memory: one line, but not a refusal.
pub const MISTAKES: [&str; 4] =
    ["this is a mistake of the program", "panicked at", "crashed (SIG", "gave up (SIG"];

/// The variable by which llvmpipe leaves out LLVM's optimisation.
const PASSES: &str = "GALLIVM_PERF";

/// A run of more pixels, in all its frames, is faster with LLVM's optimisation.
const MANY: u32 = 100_000;

/// A command that runs the binary `name` in the project's root, like a user, without a backtrace.
pub fn command(name: &str) -> Command {
    let mut command = Command::new(program(name));
    command.current_dir(root()).env_remove("RUST_BACKTRACE");
    // llvmpipe compiles the shaders of a small picture for longer than it executes them: without LLVM's
    // optimisation in a quarter of the time, to the same bits. Tests by hand and at night take times and test the
    // code that readers run.
    let is_by_day = std::env::args().all(|argument| !argument.ends_with("-ignored"));
    if is_by_day {
        command.env(PASSES, "nopt");
    }
    command
}

/// The same for tests that send signals: under `nohup` and in a script's background they would be ignored.
pub fn heeding(name: &str) -> Command {
    let mut command = Command::new("env");
    command.arg("--default-signal=INT,TERM,HUP").arg(program(name)).current_dir(root());
    command.env_remove("RUST_BACKTRACE");
    command
}

/// The path of the binary `name`, built from the current sources.
pub fn program(name: &str) -> PathBuf {
    #[cfg(unix)]
    tally::keep();
    // Cargo builds a package's binaries for that package's tests, and names them. Others are built here.
    if let Some(own) = std::env::var_os(format!("CARGO_BIN_EXE_{name}")) {
        return own.into();
    }
    static BUILT: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    // This test is in target/debug/deps.
    let test = std::env::current_exe().expect("a test has a file");
    let folder = test.parent().and_then(Path::parent).expect("it lies in a folder of Cargo's");
    let file = folder.join(name).with_extension(std::env::consts::EXE_EXTENSION);
    // `cargo test` builds all programs before it runs a test. Building one of them alone would recompile
    // dependencies, without the features enabled by tests.
    if !built.contains(name) && !is_current(&file, name) {
        let profile = match folder.file_name() {
            Some(debug) if debug == "debug" => "dev",
            other => other.and_then(|name| name.to_str()).expect("a profile's name"),
        };
        let cargo = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--profile", profile, "--bin", name])
            .current_dir(root())
            .status();
        assert!(cargo.expect("cargo starts").success(), "{name} does not build");
    }
    built.insert(name.to_owned());
    file
}

/// Returns whether a program exists, and is no older than its possible sources.
///
/// Only `cargo build` writes Cargo's own list of sources next to a program.
fn is_current(program: &Path, name: &str) -> bool {
    let modified = |path: &Path| std::fs::metadata(path).and_then(|file| file.modified()).ok();
    let of = |folder: &str| root().join(folder).join(name);
    let mut own = ["samples", "samples/assets"].into_iter().map(of).filter(|own| own.is_dir());
    let own = own.next().unwrap_or_else(|| root().join("docs"));
    let mut sources = vec![root().join("Cargo.lock")];
    let mut folders = vec![root().join("common"), own];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            match path.extension().and_then(|extension| extension.to_str()) {
                _ if path.is_dir() => folders.push(path),
                Some("rs" | "toml") => sources.push(path),
                _ => {}
            }
        }
    }
    modified(program).is_some_and(|built| {
        sources.iter().all(|source| modified(source).is_some_and(|changed| changed <= built))
    })
}

/// A program's standard error without the lines about looks of a model that its chapter does not show, such as
/// mirrors. Tests of errors check those.
fn without_looks(errors: &[u8]) -> String {
    let errors = String::from_utf8_lossy(errors);
    let is_look =
        |line: &&str| line.starts_with("warning: ") && line.contains("; this chapter shows ");
    errors.lines().filter(|line| !is_look(line)).collect::<Vec<_>>().join("\n")
}

/// Renders headless; a failure or a message fails the test. Of runs that differ in numbers only, the first is under
/// validation (see [`validated::is_new`]).
pub fn render(name: &str, size: &str, arguments: &[&str]) -> Run {
    render_by(&mut command(name), size, arguments)
}

/// The same with a command that may have another environment.
pub fn render_by(sample: &mut Command, size: &str, arguments: &[&str]) -> Run {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out.exr");
    let name = sample.get_program().to_string_lossy().into_owned();
    if pixels(size, arguments) > MANY {
        sample.env_remove(PASSES);
    }
    let validate = validated::is_new(sample, arguments).then_some("--validate");
    let output = sample
        .args(["--headless", "--report", "-", "--size", size, "--out"])
        .arg(&out)
        .args(validate)
        .args(arguments)
        .output()
        .expect("the sample starts");
    let errors = without_looks(&output.stderr);
    assert!(output.status.success(), "{name} {arguments:?}: {errors}");
    assert!(errors.is_empty(), "{name} {arguments:?} is not silent: {errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    assert_eq!(report["validation_messages"], serde_json::json!([]));
    Run { picture: Picture::open_exr(&out).expect("the picture is an EXR"), report }
}

/// The pixels of a run's frames; of a size or a number that is wrong, 0.
fn pixels(size: &str, arguments: &[&str]) -> u32 {
    let frames = arguments.iter().position(|argument| *argument == "--frames");
    let frames = frames.map_or(Some(1), |at| arguments.get(at + 1)?.parse().ok());
    let sides = size.split_once('x').and_then(|(width, height)| {
        Some((width.parse::<u32>().ok()?, height.parse::<u32>().ok()?))
    });
    let (width, height) = sides.unwrap_or_default();
    width.saturating_mul(height).saturating_mul(frames.unwrap_or_default())
}

/// The results of a shader of the book, one per pixel: the text `declarations` comes before the files of
/// 02_basic, and `body` is the `main` of a raygen shader. It reads the pixel from `ivec2 at` and sets `vec4
/// answer`.
pub fn evaluate(declarations: &str, body: &str, size: &str) -> Picture {
    let folder = copy_of_shaders();
    let text = format!(
        "#version 460\n\
         #extension GL_EXT_ray_tracing : require\n\
         #extension GL_EXT_buffer_reference2 : require\n\
         #extension GL_EXT_scalar_block_layout : require\n\
         #extension GL_GOOGLE_include_directive : require\n\
         layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D picture;\n\
         {declarations}\n\
         #include \"push.glsl\"\n\
         #include \"common/band.glsl\"\n\
         void main() {{\n\
             ivec2 at = ivec2(pixel_id());\n\
             vec4 answer = vec4(push.camera.origin, 0.0);\n\
             {body}\n\
             imageStore(picture, at, answer);\n\
         }}\n"
    );
    std::fs::write(folder.path().join("02_basic/camera.rgen"), text)
        .expect("a copy can be written");
    render_by(command("02_basic").env("SHADERS", folder.path()), size, &[]).picture
}

/// A copy of the shaders, or of a reader's own in the folder named by `SHADERS`, that a test may change.
pub fn copy_of_shaders() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let shaders = std::env::var_os("SHADERS").map_or_else(|| root().join("shaders"), PathBuf::from);
    copy(&shaders, folder.path());
    folder
}

/// A copy of `shaders/` with one line of a file replaced.
pub fn shaders_with(file: &str, from: &str, to: &str) -> tempfile::TempDir {
    let folder = copy_of_shaders();
    replace_line(folder.path(), file, from, to);
    folder
}

/// Replaces a text that must occur once in a file of a copy of the shaders.
pub fn replace_line(shaders: &Path, file: &str, from: &str, to: &str) {
    let path = shaders.join(file);
    let text = std::fs::read_to_string(&path).expect("a shader can be read");
    assert_eq!(text.matches(from).count(), 1, "{file} has not one '{from}'");
    std::fs::write(&path, text.replace(from, to)).expect("a copy can be written");
}

/// Copies a folder and all below it.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder can be made");
    for entry in from.read_dir().expect("a folder can be read") {
        let path = entry.expect("an entry").path();
        let to = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &to);
        } else {
            std::fs::copy(&path, &to).expect("a file can be copied");
        }
    }
}

/// The messages of samples if the compiler of a missing GPU is not available.
pub const NO_COMPILER: [&str; 4] = [
    "(RADV), which is not installed",
    "stands in for no such card",
    "(ANV), which is not installed",
    "what stands in for Intel's cards is not built",
];

/// A GPU family's estimates for a sample's pipelines, one row per program; `None`, with a message, if that
/// compiler is not installed.
pub fn compiled_for(name: &str, family: &str, arguments: &[&str]) -> Option<Vec<Value>> {
    let output = command(name)
        .args(["--compile-for", family, "--report", "-"])
        .args(arguments)
        .output()
        .expect("the sample starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() && NO_COMPILER.iter().any(|words| errors.contains(words)) {
        println!("not tried: {errors}");
        return None;
    }
    assert!(output.status.success(), "{name} {arguments:?}: {errors}");
    assert_eq!(errors, "", "{name} {arguments:?} is not silent");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    Some(report["compiled_for"].as_array().expect("what was compiled").clone())
}

/// Runs with wrong arguments and returns the exit code and the single line on standard error.
pub fn refused(name: &str, arguments: &[&str]) -> (i32, String) {
    refusal(command(name).args(arguments).output().expect("the sample starts"))
}

/// The exit code and the single line on standard error of a run that must have failed.
pub fn refusal(output: Output) -> (i32, String) {
    let errors = without_looks(&output.stderr);
    let code = output.status.code().unwrap_or_else(|| panic!("killed, not refused: {errors}"));
    assert_ne!(code, 0, "accepted");
    assert_eq!(errors.lines().count(), 1, "more than one line: {errors}");
    assert!(errors.starts_with("error: "), "{errors}");
    (code, errors)
}

/// Compares a picture with `tests/golden/{name}.png` by FLIP (Andersson et al. 2020).
///
/// `tolerance` is the largest mean FLIP error on the device that set it; the caller says which device that
/// is. Another device may exceed it by as much as its arithmetic allows, see [`equality`]. `UPDATE=1` writes
/// the golden picture; a missing one fails. Differences are written to `target/golden`.
pub fn golden(name: &str, picture: &Picture, tolerance: f32) {
    let Some(tolerance) = equality::golden_tolerance(name, picture, tolerance) else {
        return println!("not compared: {name} shows the errors of the device itself");
    };
    let file = root().join(format!("tests/golden/{name}.png"));
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        picture.save(&file).expect("the golden can be written");
        return;
    }
    let expected = image::open(&file)
        .unwrap_or_else(|error| {
            panic!("no golden {}: {error}; UPDATE=1 cargo test writes it", file.display())
        })
        .to_rgb8();
    assert_eq!(expected.dimensions(), (picture.width, picture.height), "{name}: the size differs");
    let (width, height) = expected.dimensions();
    let mean = flip::mean((width, height), &expected, &picture.srgb());
    if mean > tolerance {
        let kept = root().join(format!("target/golden/{name}.png"));
        std::fs::create_dir_all(kept.parent().expect("it lies in a folder")).expect("a folder");
        picture.save(&kept).expect("the picture can be kept");
        panic!("{name}: mean FLIP {mean} above {tolerance}; see {}", kept.display());
    }
}

/// Returns whether the tests' device supports the worst arithmetic; prints a message if it does not.
pub fn has_worst_arithmetic() -> bool {
    static HAS: LazyLock<bool> = LazyLock::new(|| {
        let name = |requirements| {
            let options = GpuOptions { requirements, ..GpuOptions::default() };
            Gpu::new(&options).map(|gpu| gpu.name.clone()).ok()
        };
        let wanted = Requirements::ray_tracing();
        // A device with less may support it, but it is not the one to be tested.
        device::is_software() || name(wanted.clone()) == name(wanted.float64())
    });
    if !*HAS {
        println!(
            "not tried: the device has no 64-bit floats, from which --arithmetic worst makes its errors"
        );
    }
    *HAS
}

/// Returns whether the tests' device supports a chapter; prints the missing features if it does not.
pub fn is_offered(chapter: &str) -> bool {
    if device::is_software() {
        return true;
    }
    let output = command(chapter).arg("--list-controls").output().expect("the sample starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    let lacking = !output.status.success() && errors.contains(": lacks VK_");
    if lacking {
        println!("not tried: {errors}");
    }
    !lacking
}

/// Ends a test here, with a message, if its device lacks a chapter's requirements.
#[macro_export]
macro_rules! needs {
    ($chapter:expr) => {
        if !$crate::is_offered($chapter) {
            return;
        }
    };
}

/// The chapters, in order: the folders of `samples/` that begin with a number.
pub fn chapters() -> Vec<String> {
    let folders = root().join("samples").read_dir().expect("samples/ can be read");
    let names = folders.map(|entry| entry.expect("an entry").file_name().into_string());
    let names = names.map(|name| name.expect("a chapter has a plain name"));
    let mut names: Vec<_> =
        names.filter(|name| name.starts_with(|first: char| first.is_ascii_digit())).collect();
    names.sort();
    assert!(names.len() >= 14, "{names:?}");
    names
}

/// The chapters that create their pipelines through the framework: all except 01.
pub fn chapters_on_the_framework() -> Vec<String> {
    let mut names = chapters();
    names.retain(|name| name != "01_foundation");
    names
}

/// The files, from the root, that differ from the last commit: of a sweep, plain tests run one member of each
/// kind, and everything edited. Empty without git.
pub fn changed() -> Vec<String> {
    let output = Command::new("git").args(["status", "--porcelain"]).current_dir(root()).output();
    let text = output.map_or_else(|_| Vec::new(), |output| output.stdout);
    let text = String::from_utf8_lossy(&text);
    text.lines().filter_map(|line| line.get(3..)).map(str::to_owned).collect()
}

/// The project's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("tests/run lies in it").into()
}

/// The bits of a picture, for exact comparisons.
pub fn bits(picture: &Picture) -> Vec<[u32; 4]> {
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}
