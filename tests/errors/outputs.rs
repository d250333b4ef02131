//! Pictures and reports: written completely or not at all, and refused before any work.

use std::fs;
use std::process::Stdio;
use std::time::Duration;

use crate::{refused, sample, text};

#[test]
fn files_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["folder.png", "folder.json"] {
        fs::create_dir(path(name)).unwrap();
    }
    refused(&["--out", text(&path("gone/a.png"))], 1, &["cannot write '", "there is no folder"]);
    refused(&["--report", text(&path("gone/a.json"))], 1, &["there is no folder"]);
    refused(&["--out", text(&path("folder.png"))], 1, &["it is a folder"]);
    refused(&["--report", text(&path("folder.json"))], 1, &["it is a folder"]);
    let long = path(&format!("{}.png", "a".repeat(300)));
    refused(&["--out", text(&long)], 1, &["cannot write '"]);
    assert_eq!(folder.path().read_dir().unwrap().count(), 2, "a refusal leaves nothing");
}

#[cfg(target_os = "linux")]
#[test]
fn folders_that_take_no_files_and_devices() {
    refused(&["--out", "/proc/x.png"], 1, &["cannot write '/proc/x.png': no file can be made"]);
    refused(&["--report", "/proc/x.json"], 1, &["no file can be made in '/proc'"]);
    // Links to devices, so that a mistake destroys the link and not the device.
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("null.png");
    std::os::unix::fs::symlink("/dev/null", &link).unwrap();
    for option in ["--out", "--report"] {
        refused(&[option, text(&link)], 1, &["it is a device or a pipe, not a file"]);
    }
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
}

#[test]
fn a_window_reports_nothing() {
    for report in ["-", "a.json"] {
        let mut window = run::command(super::SAMPLE);
        window.args(["--report", report]);
        super::refused_by(window, 2, &["--report needs --headless"]);
    }
}

#[test]
fn formats_that_are_unknown() {
    for name in ["a.jpg", "a", ".png", "a.png.txt", "-", "a.png/.."] {
        refused(&["--out", name], 2, &["cannot write '", "': a picture is .png or .exr"]);
    }
}

#[test]
fn one_file_for_both() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a.png", "./a.png"].map(|name| folder.path().join(name));
    refused(&["--out", text(&a), "--report", text(&b)], 2, &["--out and --report both name '"]);
}

#[test]
fn what_is_read_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let [model, same] = ["m.json", "./m.json"].map(|name| folder.path().join(name));
    fs::write(&model, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let scene = ["--scene", text(&model), "--report", text(&same)];
    refused(&scene, 2, &["--scene and --report both name '"]);
    refused(&["--report", "a.sums"], 2, &["--report a.sums: a report is .json, or -"]);
    assert!(fs::read_to_string(&model).unwrap().starts_with("v 0 0 0"));
}

#[test]
fn a_file_of_the_scene_is_no_output() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    fs::write(path("m.obj"), obj).unwrap();
    fs::write(path("m.mtl"), "newmtl a\nmap_Kd t.png\n").unwrap();
    image::RgbImage::new(2, 2).save(path("t.png")).unwrap();
    let before = fs::read(path("t.png")).unwrap();
    let [model, texture] = [path("m.obj"), path("t.png")];
    let arguments = ["--scene", text(&model), "--out", text(&texture)];
    refused(&arguments, 2, &["--out names '", "t.png', a file of the scene"]);
    assert_eq!(fs::read(texture).unwrap(), before);
}

#[test]
fn a_failed_run_leaves_the_files_that_were_there() {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["a.png", "a.json"].map(|name| folder.path().join(name));
    for file in [&out, &report] {
        fs::write(file, "precious").unwrap();
    }
    let outputs = ["--out", text(&out), "--report", text(&report)];
    for wrong in [["--set", "bogus=1"], ["--scene", "gone.obj"], ["--device", "99"]] {
        let (code, _) = run::refusal(sample().args(outputs).args(wrong).output().unwrap());
        assert!(code == 1 || code == 2);
        for file in [&out, &report] {
            assert_eq!(fs::read_to_string(file).unwrap(), "precious", "{wrong:?}");
        }
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 2);
}

#[test]
fn names_that_are_odd() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a b.png", "ü 象.exr", "A.PNG"] {
        let status = sample().current_dir(&folder).args(["--out", name]).status().unwrap();
        assert!(status.success(), "{name}");
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    let status = sample().current_dir(&folder).arg("--out=-x.png").status().unwrap();
    assert!(status.success() && folder.path().join("-x.png").is_file());
    assert_eq!(folder.path().read_dir().unwrap().count(), 4);
}

#[test]
fn a_run_that_is_killed_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = sample();
    command.current_dir(&folder).args(["--frames", "4000000000", "--out", "a.png"]);
    let mut child = command.spawn().unwrap();
    time_limit::wait_until_worked(&mut child, Duration::from_millis(700));
    assert!(child.try_wait().unwrap().is_none(), "it was to render for days");
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn a_run_that_is_asked_to_end_leaves_no_half_written_file() {
    let signal = |child: &std::process::Child, name: &str| {
        let id = child.id().to_string();
        let sent = std::process::Command::new("kill").args(["-s", name, &id]).status().unwrap();
        assert!(sent.success());
    };
    let mut caught = 0;
    for name in ["INT", "TERM", "HUP"].into_iter().cycle().take(12) {
        let folder = tempfile::tempdir().unwrap();
        let files = || {
            let files = folder.path().read_dir().unwrap();
            files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>()
        };
        // It writes after each sample. The second signal does not wait for the writing to finish.
        let mut command = run::heeding("04_jitter_camera");
        command.args(["--size", "400x400", "--samples", "0..100000", "--save-every", "0"]);
        command.current_dir(&folder).args(["--save", "a.sums"]).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        while !files().iter().any(|name| name.starts_with(".tmp")) {
            assert!(child.try_wait().unwrap().is_none(), "it was to render for hours");
            std::thread::sleep(Duration::from_micros(200));
        }
        signal(&child, name);
        std::thread::sleep(Duration::from_millis(1));
        signal(&child, name);
        caught += usize::from(child.wait().unwrap().code().is_none());
        let left = files();
        assert!(left.iter().all(|name| name == "a.sums"), "{name}: {left:?}");
    }
    assert!(caught > 0, "no run was ended by its second signal");
}

#[test]
fn two_runs_may_write_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let start = || {
        let mut command = sample();
        command.current_dir(&folder).args(["--out", "a.png"]).spawn().unwrap()
    };
    for mut child in [start(), start(), start()] {
        assert!(child.wait().unwrap().success());
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 1);
    assert_eq!(image::open(folder.path().join("a.png")).unwrap().width(), 8);
}

#[test]
fn a_reader_that_has_read_enough_is_no_error() {
    for arguments in [
        &["--list-controls"][..],
        &["--list-devices"],
        &["--report", "-"],
        &["--compare", "show=picture|normal"],
        &["--help"],
    ] {
        let mut command = sample();
        command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {errors}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said() {
    let full = || fs::File::options().write(true).open("/dev/full").unwrap();
    for arguments in [&["--list-controls"][..], &["--list-devices"], &["--report", "-"]] {
        let output = sample().args(arguments).stdout(full()).output().unwrap();
        let (code, line) = run::refusal(output);
        assert_eq!(code, 1, "{line}");
        assert!(line.contains("cannot write to standard output: No space left"), "{line}");
    }
    // The message cannot be printed anywhere, but the exit code is right.
    let status = sample().arg("--bogus").stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(2));
}
