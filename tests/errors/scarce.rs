//! A machine that lacks address space, threads, or room for a file. A run ends with a picture or with one
//! line, and leaves a file unchanged or writes it completely.
#![cfg(target_os = "linux")]

use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::Path;
use std::process::{Command, Output};

use instruments::sums::{Header, Origin, Sums};
use run::cards::{Card, said};
use time_limit::ASLEEP;

/// A program under a resource limit, in the form used by `prlimit`.
fn limited(limit: &str, program: &str) -> Command {
    let mut command = Command::new("prlimit");
    command.arg(limit).arg(run::program(program)).current_dir(run::root());
    // A developer's own setting would leave crashes to the system.
    command.env_remove("RUST_BACKTRACE");
    command
}

/// Checks for exit code 0 without output, or 1 with one line of the program's own; returns whether it was the
/// first.
///
/// Rust, the driver and its compiler may print lines of their own before that line; a GPU's driver may do so
/// at any failure.
#[track_caller]
fn done_or_said(what: &str, output: Output) -> bool {
    let errors = String::from_utf8_lossy(&output.stderr);
    // When memory is short a driver may crash, but this program's own code may not panic.
    assert!(!errors.contains("mistake of the program"), "{what}: {errors}");
    let own = errors.lines().filter(|line| line.starts_with("error: ")).count();
    match output.status.code() {
        Some(0) => assert!(own == 0, "{what}: {errors}"),
        Some(1) => {
            let last = errors.lines().last().unwrap_or_default();
            assert!(own == 1 && last.starts_with("error: "), "{what}: {errors}");
            let may_write = last.contains("gave up") || !run::device::is_software();
            assert!(errors.lines().count() == 1 || may_write, "{what}: {errors}");
        }
        _ => panic!("{what}: {}, {errors}", output.status),
    }
    output.status.success()
}

/// Runs a sample in this many megabytes of address space, or without a limit; returns whether there is a
/// picture.
fn in_megabytes(sample: &str, megabytes: impl Into<Option<u64>>) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("a.png");
    let megabytes = megabytes.into();
    let bytes = megabytes.map_or("unlimited".to_owned(), |size| (size << 20).to_string());
    let mut command = limited(&format!("--as={bytes}"), sample);
    command.args(["--headless", "--size", "8x8", "--out"]).arg(&picture);
    let done = done_or_said(&format!("{sample}, {megabytes:?} MB"), command.output().unwrap());
    assert_eq!(picture.exists(), done, "{sample}, {megabytes:?} MB");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), usize::from(done));
    done
}

#[test]
fn with_any_address_space_there_is_a_picture_or_one_line() {
    // The software driver renders in 4000; a GPU's driver may reserve more than the card's whole memory.
    let enough = run::device::is_software().then_some(4000);
    let sizes = (200..=1000).step_by(50).map(Some).chain([enough]);
    let done: Vec<bool> = sizes.map(|size| in_megabytes("02_basic", size)).collect();
    assert!(!done[0] && done[done.len() - 1], "{done:?}");
}

#[test]
#[ignore = "nightly: every chapter in steps of 25 MB; quick: scarce::with_any_address_space_there_is_a_picture_or_one_line"]
fn so_it_is_in_every_chapter() {
    for sample in run::chapters() {
        let done = (200..=1400).step_by(25).filter(|size| in_megabytes(&sample, *size)).count();
        println!("{sample}: {done} pictures of 49");
    }
}

#[test]
fn with_any_number_of_open_files_there_is_a_picture_or_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("a.png");
    let render = ["--headless", "--size", "8x8", "--out", picture.to_str().unwrap()];
    let programs = [("01_foundation", &render[..]), ("02_basic", &render), ("chapters", &["list"])];
    for (program, arguments) in programs {
        // With only three, for its standard streams, the system cannot load it.
        for files in [4, 5, 6, 12, 63, 64] {
            let limit = format!("--nofile={files}");
            let output = limited(&limit, program).args(arguments).output().unwrap();
            let errors = String::from_utf8_lossy(&output.stderr).into_owned();
            let done = done_or_said(&format!("{program}, {files} files"), output);
            let line = format!(
                "error: the system lets this process have {files} files open at once; 64 are enough: ulimit -n 64\n"
            );
            assert!(if files < 64 { errors == line } else { done }, "{program}: {errors}");
        }
    }
}

/// A user who owns no files or processes.
const NOBODY: &str = "61234";

/// Runs a command as a user other than root, whom limits do not bind; `None`, with a message, if that is
/// impossible.
pub fn as_nobody(command: &Command) -> Option<Command> {
    let nobody = ["--reuid", NOBODY, "--regid", NOBODY, "--clear-groups"];
    let mut reads = Command::new("setpriv");
    reads.args(nobody).args(["test", "-r"]).arg(run::root().join("Cargo.toml"));
    let may_read = reads.output();
    if !may_read.is_ok_and(|output| output.status.success()) {
        println!("not tried: this needs root, and a project that others may read");
        return None;
    }
    let mut other = Command::new("setpriv");
    other.args(nobody).arg(command.get_program()).args(command.get_args());
    // The driver would complain that it has no home for its cache.
    other.current_dir(run::root()).env("MESA_SHADER_CACHE_DISABLE", "1");
    other.env_remove("RUST_BACKTRACE");
    Some(other)
}

#[test]
fn with_any_number_of_threads_there_is_a_picture_or_one_line() {
    for sample in ["01_foundation", "02_basic"] {
        let software = run::device::is_software();
        with_any_number_of_threads(sample, (1..8).chain([64]), &[], software);
    }
}

/// The software driver needs threads of its own to make a picture; a GPU's driver may not.
#[test]
fn a_gpu_s_driver_may_render_with_any_number_of_threads() {
    let Some(card) = Card("navi31").environment() else { return };
    with_any_number_of_threads("02_basic", [1, 64], &card, false);
}

fn with_any_number_of_threads(
    sample: &str,
    numbers: impl IntoIterator<Item = u32>,
    device: &[(&str, OsString)],
    needs_threads: bool,
) {
    let mut done = Vec::new();
    for threads in numbers {
        let mut command = limited(&format!("--nproc={threads}"), sample);
        command.args(["--headless", "--size", "8x8"]);
        let Some(command) = as_nobody(&command) else { return };
        // A run that never ends is a failure.
        let seconds = ASLEEP.as_secs().to_string();
        let mut patient = Command::new("timeout");
        patient.args(["-s", "KILL", &seconds]).arg(command.get_program()).args(command.get_args());
        for (name, value) in command.get_envs() {
            value.map(|value| patient.env(name, value));
        }
        patient.envs(device.iter().cloned()).env_remove("RUST_BACKTRACE");
        let mut output = patient.current_dir(run::root()).output().unwrap();
        // The driver stub prints lines of its own about the missing card.
        output.stderr = said(&output).into_bytes();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        done.push(done_or_said(&format!("{sample}, {threads} threads"), output));
        if threads == 1 && needs_threads {
            assert!(errors.contains("starts no more (ulimit -u)"), "{errors}");
        }
    }
    assert!(!(done[0] && needs_threads) && done[done.len() - 1], "{done:?}");
}

/// Merges to a file with every limit on file size from none to enough, in these steps. `merge` writes with
/// the same code as a render, and needs no driver, which would write files of its own. Before that the file
/// contains `before`, or does not exist.
fn at_every_byte(
    name: &str,
    step: usize,
    before: Option<&[u8]>,
    write: impl Fn(Command, &Path) -> Command,
) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    let run = |limit: &str| {
        let _ = fs::remove_file(&file);
        if let Some(bytes) = before {
            fs::write(&file, bytes).unwrap();
        }
        write(limited(limit, "chapters"), &file).output().expect("prlimit starts")
    };
    let output = run("--fsize=unlimited");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let whole = fs::read(&file).unwrap();
    for bytes in (0..whole.len()).step_by(step).chain([whole.len() - 1, whole.len()]) {
        let output = run(&format!("--fsize={bytes}"));
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        let what = format!("{name}, {bytes} of {} bytes", whole.len());
        let done = done_or_said(&what, output);
        assert_eq!(done, bytes == whole.len(), "{what}: {errors}");
        assert!(done || errors.contains("file too large"), "{what}: {errors}");
        let expected = if done { Some(&whole[..]) } else { before };
        assert!(fs::read(&file).ok().as_deref() == expected, "{what}: neither the old nor the new");
        let left = fs::read_dir(&folder).unwrap().count();
        assert_eq!(left, usize::from(expected.is_some()), "{what}: more is left");
    }
    println!("{name}: {} bytes", whole.len());
}

/// A file of sums with these samples of a small picture.
fn sums(file: &Path, samples: Range<u32>) {
    let origin = Origin { size: [3, 2], shaders: Some(0), ..Origin::default() };
    let header = Header { origin, samples: samples.into(), ..Header::default() };
    let values = (0..24).map(|value| i128::from(value) << 60).collect();
    Sums { header, values }.save(file).expect("it can be written");
}

#[test]
fn on_a_disk_that_is_full_after_any_byte_a_merged_file_is_whole_or_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let [part, other] = ["part.sums", "other.sums"].map(|name| folder.path().join(name));
    sums(&part, 0..4);
    sums(&other, 4..6);
    let merge = |mut command: Command, out: &Path| {
        command.arg("merge").arg(out).arg(&part);
        command
    };
    at_every_byte("a.png", 1, Some(b"precious"), merge);
    at_every_byte("a.exr", 7, None, merge);
    let into_one = |mut command: Command, out: &Path| {
        command.arg("merge").arg(out).arg(&part).arg(out);
        command
    };
    at_every_byte("a.sums", 5, Some(&fs::read(other).unwrap()), into_one);
}

/// Renders to a disk with room for this many pages of 4096 bytes, which has a file `a.exr`; returns whether a
/// successful run has replaced it. `None`, with a message, if no disk can be mounted.
fn on_disk(pages: usize, whole: &[u8]) -> Option<bool> {
    let folder = tempfile::tempdir().unwrap();
    let [disk, after, list] = ["disk", "after.exr", "list"].map(|name| folder.path().join(name));
    fs::create_dir(&disk).unwrap();
    // Only this shell sees the mount.
    let script = "mount -t tmpfs -o size=64k none \"$1\" || exit 77
        cd \"$1\" && printf precious > a.exr && head -c \"$2\" /dev/zero > fill
        \"$3\" --headless --size 32x32 --out a.exr; code=$?
        cp a.exr \"$4\"; ls -A > \"$5\"; exit $code";
    let filled = (16 - 1 - pages) * 4096;
    let mut command = Command::new("unshare");
    command.args(["--map-root-user", "--mount", "sh", "-c", script, "sh"]).arg(&disk);
    command.arg(filled.to_string()).arg(run::program("02_basic")).args([&after, &list]);
    let output = command.env_remove("RUST_BACKTRACE").output().unwrap();
    if !after.exists() {
        println!("not tried: {}", String::from_utf8_lossy(&output.stderr));
        return None;
    }
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let done = done_or_said(&format!("{pages} pages"), output);
    assert!(done || errors.contains("no storage space"), "{errors}");
    assert_eq!(fs::read_to_string(list).unwrap(), "a.exr\nfill\n", "{pages} pages");
    let expected = if done { whole } else { b"precious" };
    assert!(fs::read(after).unwrap() == expected, "{pages} pages: neither the old nor the new");
    Some(done)
}

#[test]
fn on_a_full_disk_a_rendered_file_is_whole_or_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("whole.exr");
    let mut command = run::command("02_basic");
    command.args(["--headless", "--size", "32x32", "--out"]).arg(&file);
    assert!(command.status().unwrap().success());
    let whole = fs::read(&file).unwrap();
    let needed = whole.len().div_ceil(4096);
    assert!((2..12).contains(&needed), "{} bytes", whole.len());
    for pages in 0..=needed {
        let Some(done) = on_disk(pages, &whole) else { return };
        assert_eq!(done, pages == needed, "{pages} of {needed} pages");
    }
}
