//! Signals at any moment of a run, from its start to its last byte: it ends by the signal or with one line,
//! and leaves nothing half-written.
#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use common::app::Picture;
use instruments::sums::Sums;
use reference::random::Random;

const SIGNALS: [(&str, i32); 3] = [("INT", 2), ("TERM", 15), ("HUP", 1)];

/// The number of signals for each kind of run: `usual`, or as set in the environment.
fn rounds(usual: u32) -> u32 {
    std::env::var("ROUNDS").map_or(usual, |text| text.parse().expect("ROUNDS is a number"))
}

/// Returns whether a file is one that a run writes, and complete.
fn is_whole(file: &Path) -> bool {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("png") => image::open(file).is_ok(),
        Some("exr") => Picture::open_exr(file).is_ok(),
        Some("sums") => Sums::open(file).is_ok(),
        Some("json") => fs::read(file)
            .is_ok_and(|bytes| serde_json::from_slice::<serde_json::Value>(&bytes).is_ok()),
        _ => false,
    }
}

/// Returns whether a file in a folder is being written.
fn writes(folder: &Path) -> bool {
    let mut files = fs::read_dir(folder).expect("a folder").map(|file| file.unwrap().file_name());
    files.any(|name| name.to_string_lossy().starts_with(".tmp"))
}

/// Sends signals to runs of a command, each in its own folder, at random moments of a run; every other signal
/// then waits until a file is being written.
fn at_any_moment(usual: u32, command: impl Fn(&Path, u32) -> Command) {
    let mut random = Random(1);
    let (mut longest, mut counts) = (Duration::ZERO, [0; 3]);
    for round in 0..=rounds(usual) {
        let folder = tempfile::tempdir().unwrap();
        let mut command = command(folder.path(), round);
        let before = fs::read_dir(&folder).unwrap().count();
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).env_remove("RUST_BACKTRACE");
        let start = Instant::now();
        let mut child = command.spawn().expect("it starts");
        let (name, number) = SIGNALS[random.below(3)];
        // The first run measures the duration.
        if round > 0 {
            // Starting a program takes longer than writing a file, so this one is started in advance.
            let send = "read moment; kill -s \"$0\" \"$1\" 2>/dev/null";
            let mut sender = Command::new("sh");
            sender.args(["-c", send, name, &child.id().to_string()]).stdin(Stdio::piped());
            let mut sender = sender.spawn().expect("a shell");
            std::thread::sleep(longest.mul_f64(random.between(0.0, 1.0)));
            while round % 2 == 0 && !writes(folder.path()) && child.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_micros(20));
            }
            drop(sender.stdin.take());
            sender.wait().expect("it ends");
        }
        let output = child.wait_with_output().expect("it ends");
        longest = longest.max(if round == 0 { start.elapsed() } else { Duration::ZERO });
        let errors = String::from_utf8_lossy(&output.stderr);
        let what = format!("round {round}, {name}: {}, {errors}", output.status);
        match (output.status.code(), output.status.signal()) {
            (None, Some(signal)) => assert!(signal == number && errors.is_empty(), "{what}"),
            (Some(0), _) => assert!(errors.is_empty(), "{what}"),
            (Some(1 | 3), _) => assert_eq!(errors.lines().count(), 1, "{what}"),
            _ => panic!("{what}"),
        }
        counts[output.status.code().map_or(2, |code| usize::from(code != 0))] += 1;
        let files = fs::read_dir(&folder).unwrap().map(|file| file.unwrap().path());
        let files: Vec<_> = files.collect();
        assert!(files.len() >= before, "{what}: a file is lost");
        for file in files {
            assert!(is_whole(&file), "{what}: {} is left", file.display());
        }
    }
    let [done, said, killed] = counts;
    println!("{longest:?} a run; {done} done, {said} stopped in a line, {killed} by the signal");
}

/// The shaders of 02 with new text, so that no cache has them.
fn unknown_shaders(folder: &Path, round: u32) {
    run::copy(&run::root().join("shaders/common"), &folder.join("common"));
    run::copy(&run::root().join("shaders/02_basic"), &folder.join("02_basic"));
    let camera = folder.join("02_basic/camera.rgen");
    let text = fs::read_to_string(&camera).unwrap();
    fs::write(&camera, format!("{text}// {round} {}\n", std::process::id())).unwrap();
}

#[test]
fn a_signal_may_come_while_shaders_are_compiled_a_scene_is_built_and_a_picture_made() {
    let shaders = tempfile::tempdir().unwrap();
    at_any_moment(12, |folder, round| {
        unknown_shaders(shaders.path(), round);
        let mut command = run::heeding("02_basic");
        command.current_dir(folder).env("SHADERS", shaders.path());
        command.args(["--headless", "--size", "400x300", "--out", "a.png"]);
        command.args(["--report", "a.json"]);
        command
    });
}

#[test]
fn a_signal_may_come_while_samples_are_gathered_and_saved() {
    at_any_moment(12, |folder, _| {
        let mut command = run::heeding("04_jitter_camera");
        command.current_dir(folder).args(["--size", "200x150", "--samples", "0..12"]);
        command.args(["--save", "a.sums", "--save-every", "0", "--out", "a.exr"]);
        command
    });
}

#[test]
fn a_signal_may_come_while_files_are_merged() {
    let parts = tempfile::tempdir().unwrap();
    let [a, b] = ["0..2", "2..4"].map(|samples| {
        let file = parts.path().join(samples);
        let mut command = run::command("04_jitter_camera");
        command.args(["--size", "600x400", "--samples", samples, "--save"]).arg(&file);
        assert!(command.status().unwrap().success());
        file
    });
    at_any_moment(40, |folder, _| {
        fs::copy(&a, folder.join("all.sums")).unwrap();
        let mut command = run::heeding("chapters");
        command.current_dir(folder).args(["merge", "all.sums", "all.sums"]).arg(&b);
        command
    });
}

#[cfg(target_os = "linux")]
#[test]
fn a_crash_ends_in_one_line_unless_a_backtrace_is_asked_for() {
    let crash = |signal: &str, traced: &str| {
        let mut command = crate::sample();
        command.args(["--frames", "4000000000"]).env("RUST_BACKTRACE", traced);
        let mut child = command.stderr(Stdio::piped()).spawn().expect("it starts");
        // By then it is rendering.
        time_limit::wait_until_worked(&mut child, Duration::from_secs(1));
        let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(sent.expect("kill").success());
        child.wait_with_output().expect("it ends")
    };
    for signal in ["SEGV", "BUS", "ILL", "FPE", "ABRT"] {
        let (code, line) = run::refusal(crash(signal, "0"));
        assert_eq!(code, 1, "{line}");
        assert!(line.contains("the driver or the shader compiler"), "{line}");
        assert!(line.contains(&format!("(SIG{signal})")), "{line}");
    }
    assert_eq!(crash("ABRT", "1").status.signal(), Some(6));
}
