//! The bytes of a render are the same however it is cut, stopped, repeated and merged.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::Duration;

use common::app::Picture;
use instruments::sums::{Header, merge};
use run::{bits, command, has_worst_arithmetic, heeding, refusal, render};
use tempfile::TempDir;

/// A sample that accumulates frames, and a fast one.
const NAME: &str = "04_jitter_camera";
/// Small: the test is about cutting a render into parts, not about the picture.
const SIZE: [&str; 2] = ["--size", "24x16"];

/// A folder with a chapter's files of sums.
struct Parts {
    folder: TempDir,
    chapter: &'static str,
}

impl Parts {
    fn new() -> Self {
        Self::of(NAME)
    }

    fn of(chapter: &'static str) -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder"), chapter }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The command that starts or continues a part.
    fn task(&self, samples: &str, file: &str) -> Command {
        let file = self.path(file);
        let mut task = heeding(self.chapter);
        task.args(SIZE).args(["--samples", samples, "--save-every", "0", "--save"]);
        task.arg(&file).arg("--resume").arg(&file);
        task
    }

    /// Runs a task to its end.
    fn done(&self, samples: &str, file: &str) -> PathBuf {
        let output = self.task(samples, file).output().expect("the sample starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && errors.is_empty(), "{samples}: {errors}");
        self.path(file)
    }

    /// The bytes of an uninterrupted render.
    fn whole(&self, end: u32) -> Vec<u8> {
        fs::read(self.done(&format!("0..{end}"), &format!("whole-{end}"))).expect("it is there")
    }

    /// Starts a task that would take days, and waits until this many samples are saved.
    fn long_task(&self, file: &str, samples: u64) -> Child {
        let child = self.task("0..4000000000", file).stderr(std::process::Stdio::piped()).spawn();
        let mut child = child.expect("the sample starts");
        while count(&self.path(file)) < samples {
            assert!(child.try_wait().expect("a child").is_none(), "it was to render for days");
            std::thread::sleep(Duration::from_millis(5));
        }
        child
    }
}

/// The number of samples in a file.
fn count(file: &Path) -> u64 {
    Header::open(file).map_or(0, |header| header.samples.count())
}

/// The bytes of several files merged.
fn merged(files: &[PathBuf]) -> Vec<u8> {
    let files: Vec<_> = files.iter().map(PathBuf::as_path).collect();
    merge(&files).expect("they fit").bytes().expect("they can be written")
}

#[test]
fn of_two_runs_that_save_into_one_file_only_one_succeeds() {
    let parts = Parts::new();
    let tasks = ["0..1", "1..150"].map(|samples| parts.task(samples, "all.sums").spawn().unwrap());
    let ended = tasks.map(|mut task| task.wait().unwrap().success());
    assert_eq!(ended.iter().filter(|success| **success).count(), 1, "{ended:?}");
}

#[test]
fn a_render_cut_two_and_seven_ways_is_the_render_in_one_piece() {
    let parts = Parts::new();
    let whole = parts.whole(16);
    for cuts in [&[9][..], &[1, 3, 4, 9, 12, 13]] {
        let ends = cuts.iter().copied().chain([16]);
        let mut files: Vec<_> = [0]
            .iter()
            .chain(cuts)
            .zip(ends)
            .map(|(start, end)| {
                parts.done(&format!("{start}..{end}"), &format!("{}-{start}", cuts.len()))
            })
            .collect();
        assert_eq!(merged(&files), whole, "{cuts:?}");
        files.reverse();
        assert_eq!(merged(&files), whole, "{cuts:?}, backwards");
    }
    // Samples out of order, and all in one file.
    for samples in ["12..14", "0..3", "0..16"] {
        parts.done(samples, "one");
    }
    assert_eq!(fs::read(parts.path("one")).unwrap(), whole);
}

/// In every chapter that accumulates frames, a sample must depend only on its number.
#[test]
fn so_it_is_in_every_chapter_that_gathers() {
    for chapter in ["11_path_tracing", "27_glass", "28_depth_of_field", "37_sequences"] {
        let parts = Parts::of(chapter);
        let whole = parts.whole(7);
        let files = ["4..7", "0..1", "1..4"].map(|samples| parts.done(samples, samples));
        assert_eq!(merged(&files), whole, "{chapter}");
        for samples in ["2..3", "0..5", "0..7"] {
            parts.done(samples, "one");
        }
        assert_eq!(fs::read(parts.path("one")).unwrap(), whole, "{chapter}, in one file");
    }
}

#[test]
fn a_task_that_is_killed_goes_on() {
    let parts = Parts::new();
    let mut child = parts.long_task("part", 3);
    child.kill().unwrap();
    child.wait().unwrap();
    let done = count(&parts.path("part"));
    assert!(done >= 3);
    parts.done(&format!("0..{}", done + 2), "part");
    assert_eq!(fs::read(parts.path("part")).unwrap(), parts.whole(done as u32 + 2));
}

#[cfg(unix)]
#[test]
fn a_task_that_is_asked_to_stop_saves_what_it_has() {
    for signal in ["-INT", "-TERM"] {
        let parts = Parts::new();
        let child = parts.long_task("part", 2);
        let kill = Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(kill.expect("kill").success());
        let output = child.wait_with_output().unwrap();
        let line = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{line}");
        let done = count(&parts.path("part"));
        assert!(line.starts_with("stopped: '") && line.lines().count() == 1, "{line}");
        assert!(line.contains(&format!("has samples 0..{done};")), "{line}");
        parts.done(&format!("0..{}", done + 1), "part");
        assert_eq!(fs::read(parts.path("part")).unwrap(), parts.whole(done as u32 + 1));
    }
}

/// A sample of a slow scene may take minutes, and nothing can be saved until it is complete.
#[cfg(unix)]
#[test]
fn a_task_that_is_asked_to_stop_before_its_first_sample_does_not_wait_for_it() {
    let parts = Parts::of("27_glass");
    // A signal that arrives before the sample begins ends any program. If the program had waited for the end
    // of the sample, there would be a file and another message.
    for wait in [1, 2, 4, 8, 16, 32, 64] {
        let mut task = heeding(parts.chapter);
        task.args(["--size", "1000x1000", "--samples", "0..4", "--save", "part"]);
        task.current_dir(&parts.folder).stderr(std::process::Stdio::piped());
        let mut child = task.spawn().expect("the sample starts");
        time_limit::wait_until_worked(&mut child, Duration::from_secs(wait));
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.expect("kill").success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(parts.folder.path().read_dir().unwrap().count(), 0);
        let line = String::from_utf8_lossy(&output.stderr);
        if let Some(code) = output.status.code() {
            assert_eq!(line, "stopped before the first sample: nothing is saved\n");
            assert_eq!(code, 3);
            return;
        }
        assert_eq!(line, "");
    }
    panic!("no sample began within a minute");
}

#[test]
fn a_task_that_runs_twice_counts_once() {
    let parts = Parts::new();
    let mut both = [0, 1].map(|_| parts.task("0..12", "part").spawn().expect("the sample starts"));
    for task in &mut both {
        assert!(task.wait().unwrap().success());
    }
    let whole = parts.whole(12);
    assert_eq!(fs::read(parts.path("part")).unwrap(), whole);
    // Once more after the end: there is nothing to render.
    parts.done("0..12", "part");
    assert_eq!(fs::read(parts.path("part")).unwrap(), whole);
}

#[test]
#[ignore = "nightly: 64 tasks; quick: long_renders::a_render_cut_two_and_seven_ways_is_the_render_in_one_piece"]
fn sixty_four_tasks_through_gnu_parallel_give_the_same_bytes_though_some_are_killed() {
    let version = Command::new("parallel").arg("--version").output();
    if !version.is_ok_and(|output| output.stdout.starts_with(b"GNU parallel")) {
        println!("not tried: there is no GNU parallel: run ./setup --tests");
        return;
    }
    let parts = Parts::new();
    // Every fifth task dies at its first attempt, after one sample; parallel repeats it.
    let task = "export SLURM_ARRAY_TASK_ID={}
        if [ $(({} % 5)) = 3 ] && [ ! -e {}.tried ]; then
            touch {}.tried
            part=part-{}.sums; first=$(({} * 2))
            \"$PROGRAM\" --size 24x16 --samples $first..$((first + 1)) --save $part --resume $part
            kill -KILL $$
        fi
        \"$SCRIPT\" 2 \"$PROGRAM\" --size 24x16";
    let numbers = (0..64).map(|number| number.to_string());
    let output = Command::new("parallel")
        .args(["--will-cite", "--retries", "2", "-j", "2", task, ":::"])
        .args(numbers)
        .env("PROGRAM", run::program(NAME))
        .env("SCRIPT", run::root().join("docs/render.sbatch"))
        .current_dir(parts.folder.path())
        .output()
        .expect("parallel starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(parts.path("3.tried").exists() && !parts.path("4.tried").exists());
    let files: Vec<_> = (0..64).map(|number| parts.path(&format!("part-{number}.sums"))).collect();
    assert_eq!(merged(&files), parts.whole(128));
}

#[test]
fn the_picture_is_the_mean_rounded_once() {
    let sample = |index: u32| {
        let samples = format!("{index}..{}", index + 1);
        render(NAME, "24x16", &["--samples", &samples]).picture
    };
    let samples: Vec<Picture> = (0..8).map(sample).collect();
    let mean = render(NAME, "24x16", &["--samples", "0..8"]).picture;
    for (i, pixel) in mean.pixels.iter().enumerate() {
        for (channel, mean) in pixel.iter().enumerate() {
            // Eight floats of 24 bits have an exact sum in 53, and an eighth of it is also exact.
            let sum: f64 = samples.iter().map(|s| f64::from(s.pixels[i][channel])).sum();
            assert_eq!(mean.to_bits(), ((sum / 8.0) as f32).to_bits(), "pixel {i}");
        }
    }
    assert_ne!(bits(&samples[0]), bits(&samples[1]), "all samples are equal");
    // A single sample is the frame of that number without accumulation.
    let frame = render(NAME, "24x16", &["--frames", "8", "--set", "accumulate=off"]).picture;
    assert_eq!(bits(&samples[7]), bits(&frame));
}

#[test]
fn rays_through_the_centre_give_the_picture_of_02() {
    let settings = ["--samples", "5..12", "--set", "jitter=off"];
    let mean = render(NAME, "24x16", &settings).picture;
    assert_eq!(bits(&mean), bits(&render("02_basic", "24x16", &[]).picture));
}

#[test]
fn bands_give_the_same_bytes() {
    let parts = Parts::new();
    let file = parts.path("bands");
    let size = ["--size", "640x400"];
    let run = |samples: &str| {
        let mut task = command(NAME);
        task.args(size)
            .args(["--samples", samples, "--save"])
            .arg(&file)
            .arg("--resume")
            .arg(&file);
        assert!(task.status().expect("the sample starts").success());
    };
    // The first picture of a process is traced in many bands, the following ones in few.
    ["0..1", "1..2", "2..3"].into_iter().for_each(run);
    let cut = fs::read(&file).unwrap();
    fs::remove_file(&file).unwrap();
    run("0..3");
    assert_eq!(fs::read(&file).unwrap(), cut);
}

#[test]
fn a_colour_that_is_no_number_is_added_as_black_and_told() {
    let shaders = run::shaders_with(
        "04_jitter_camera/camera.rgen",
        "ivec2 pixel = ivec2(id);",
        "ivec2 pixel = ivec2(id); if (id == uvec2(5, 2) && push.frame == 1) payload.g = 0.0 / 0.0;",
    );
    let parts = Parts::new();
    let out = parts.path("a.exr");
    let output = command(NAME)
        .args(SIZE)
        .args(["--samples", "0..4", "--out"])
        .arg(&out)
        .env("SHADERS", shaders.path())
        .output()
        .expect("the sample starts");
    assert!(output.status.success());
    let line = String::from_utf8_lossy(&output.stderr);
    let expected = "warning: a colour of 1 samples, the first in pixel 5,2, is not finite";
    assert!(line.starts_with(expected), "{line}");
    let mean = Picture::open_exr(&out).unwrap();
    assert_eq!(mean.pixels[2 * 24 + 5][3], 0.75, "alpha tells how many were added");
    assert!(mean.pixels.iter().flatten().all(|value| value.is_finite()));
}

/// Every float is added exactly, or rounded to a multiple of 2^-64, for every sign and size.
#[test]
fn the_shader_adds_every_kind_of_float_as_whole_numbers() {
    let declarations = "#include \"common/random.glsl\"\n#include \"common/sum.glsl\"";
    let body = |row: &str| {
        format!(
            "uvec4 key = hash(uvec4(at, 7, 0));
             uvec4 sum = key;
             uint exponent = 1 + uint(at.x) % {};
             float value = uintBitsToFloat((key.y & 0x807fffffu) | (exponent << 23));
             add_to_sum(sum, value);
             uvec4 word = {row};
             answer = vec4(word);",
            127 + 30
        )
    };
    let halves = ["sum & 0xffffu", "sum >> 16", "key & 0xffffu", "key >> 16"];
    let size = "157x8";
    let pictures = halves.map(|half| run::evaluate(declarations, &body(half), size));
    let number = |low: usize, pixel: usize| {
        let words = [0, 1, 2, 3].map(|word| {
            let [low, high] = [low, low + 1].map(|p| pictures[p].pixels[pixel][word] as u32);
            u128::from(low | high << 16)
        });
        (words[0] | words[1] << 32 | words[2] << 64 | words[3] << 96) as i128
    };
    let mut kinds = [0; 3];
    for pixel in 0..pictures[0].pixels.len() {
        let (sum, before) = (number(0, pixel), number(2, pixel));
        let exponent = 1 + (pixel as u32 % 157) % 157;
        let key = (before as u128 >> 32) as u32;
        let value = f32::from_bits(key & 0x807f_ffff | exponent << 23);
        // 24 bits scaled by a power of two: exact in f64, and an integer unless tiny.
        let units = (f64::from(value) * 2f64.powi(64)).abs();
        let units = (units + 0.5).floor() as i128 * if value < 0.0 { -1 } else { 1 };
        assert_eq!(sum.wrapping_sub(before), units, "{value}");
        let kind = if units == 0 { 0 } else { 1 + usize::from(units < 0) };
        kinds[kind] += 1;
    }
    assert!(kinds.iter().all(|&count| count > 200), "{kinds:?}");
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let parts = Parts::new();
    let file = parts.done("0..2", "part");
    let name = file.to_str().unwrap();
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let (actual, line) = refusal(command(NAME).args(arguments).output().unwrap());
        assert_eq!(actual, code, "{line}");
        words.iter().for_each(|word| assert!(line.contains(word), "'{word}' is not in {line}"));
    };
    let resume = ["--samples", "0..4", "--out", "never.exr", "--resume", name];
    let with = |more: &[&'static str]| [&resume, more].concat();
    refused(&with(&[]), 1, &["does not fit: the size is 24x16 in it and 960x600 here"]);
    let filter = with(&["--size", "24x16", "--set", "filter=box"]);
    let other = "part does not fit: 'filter' is 'Blackman-Harris' in it and 'box' here";
    refused(&filter, 1, &[other]);
    let scene = with(&["--size", "24x16", "--scene", "samples/assets/chess.obj"]);
    refused(&scene, 1, &["'camera eye' is '-5.6,4.8,9.2' in it"]);
    // Another scene also has another camera, but that is not the reported fault.
    let scene = with(&["--size", "24x16", "--scene", "samples/assets/box_on_plane.obj"]);
    refused(&scene, 1, &["the CRC-32 of 'chess.mtl' is ", " in it and nothing here"]);
    if has_worst_arithmetic() {
        let worst = with(&["--size", "24x16", "--arithmetic", "worst"]);
        refused(&worst, 1, &["--arithmetic is 'driver'"]);
    }
    let unordered = with(&["--size", "24x16", "--unordered"]);
    refused(&unordered, 1, &["--unordered is false in it and true here"]);
    let lost = ["--headless", "--samples", "0..4"];
    refused(&lost, 2, &["--samples would store nothing: add --out for the picture or --save"]);
    // Not even a file of the same command is overwritten.
    let again = ["--size", "24x16", "--samples", "0..2", "--save", name];
    refused(&again, 1, &["exists: --resume '", "part' continues it"]);
    fs::write(parts.path("text"), "Once upon a time").unwrap();
    let text = parts.path("text");
    let kept = ["--samples", "0..4", "--out", "never.exr"];
    let resume = [&kept[..], &["--resume", text.to_str().unwrap()]].concat();
    refused(&resume, 1, &["text: was not written by --save"]);
    let gone = parts.path("gone");
    let resume = [&kept[..], &["--resume", gone.to_str().unwrap()]].concat();
    refused(&resume, 1, &["gone: there is no such file"]);
    let mut bytes = fs::read(&file).unwrap();
    bytes.pop();
    fs::write(&file, bytes).unwrap();
    let resume = [&kept[..], &["--resume", name]].concat();
    refused(&resume, 1, &["part: is damaged: it is cut off, or"]);
    refused(&["--samples", "4"], 2, &["samples are A..B", "such as 0..64"]);
    refused(&["--samples", "4..4"], 2, &["samples are A..B, and A must be below B"]);
    refused(&["--samples", "0..4294967296"], 2, &["B is at most 4294967295"]);
    refused(
        &["--samples", "0..4", "--save", "-"],
        2,
        &["--save -: sums of samples are not a picture"],
    );
    let picture = ["--size", "24x16", "--samples", "0..2", "--save", text.to_str().unwrap()];
    refused(&picture, 1, &["text' exists and was not written by --save: choose another name"]);
    let out = ["--samples", "0..4", "--resume", name, "--save", name, "--report", name];
    refused(&out, 2, &["--resume and --report both name '"]);
    let picture = ["--samples", "0..4", "--save", "part.PNG"];
    refused(&picture, 2, &["--save part.PNG: sums of samples are not a picture"]);
    refused(&["--samples", "0..4", "--frames", "4"], 2, &["cannot be used with"]);
    let off = [&kept[..], &["--set", "accumulate=off"]].concat();
    refused(
        &off,
        2,
        &["04_jitter_camera has no --samples with these values of --set: each of its frames is"],
    );
    let (code, line) = run::refused("02_basic", &kept);
    let said = "02_basic has no --samples: each of its frames is a picture by itself, not a sample of \
                one; docs/long-renders.md names the chapters that gather samples";
    assert!(code == 2 && line.contains(said), "{line}");
}

#[test]
fn other_shaders_are_refused_and_nothing_is_lost() {
    let parts = Parts::new();
    let file = parts.done("0..2", "part");
    let before = fs::read(&file).unwrap();
    let shaders = run::shaders_with("common/filter.glsl", "return u - 0.5;", "return u - 0.4;");
    let mut task = parts.task("0..4", "part");
    let (code, line) = refusal(task.env("SHADERS", shaders.path()).output().unwrap());
    assert!(code == 1 && line.contains("does not fit: the CRC-32 of the shaders is "), "{line}");
    assert_eq!(fs::read(&file).unwrap(), before);
}
