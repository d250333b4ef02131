//! The report card of a device: its contents when all is well, and the report of each kind of failure.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use run::{copy, expected, program, root};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::fixture::{Fixture, Outcome, run};
use crate::{Case, expect};

/// A project whose golden pictures come from its own programs.
fn project() -> Fixture {
    let fixture = Fixture::new();
    for name in ["01_one", "02_basic"] {
        let picture = fixture.path(&format!("docs/images/{name}.png"));
        fs::copy(picture, fixture.path(&format!("tests/golden/{name}.png"))).expect("a golden");
    }
    fixture
}

/// The tool next to programs: real ones, unless a script replaces them.
fn programs(scripts: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let place = |name: &str| folder.path().join(format!("{name}{EXE_SUFFIX}"));
    fs::copy(program("chapters"), place("chapters")).expect("the tool");
    for name in ["01_one", "02_basic"] {
        match scripts.iter().find(|(replaced, _)| *replaced == name) {
            Some((_, script)) => executable(&place(name), script),
            None => drop(fs::copy(program("02_basic"), place(name)).expect("a program")),
        }
    }
    folder
}

#[cfg(unix)]
fn executable(path: &Path, script: &str) {
    use std::os::unix::fs::PermissionsExt;
    fs::write(path, format!("#!/bin/sh\n{script}\n")).expect("a script");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("a script may be run");
}

#[cfg(not(unix))]
fn executable(_: &Path, _: &str) {
    unreachable!("scripts stand in for programs on Unix alone");
}

/// Surveys a project; returns the tool's result and the card.
fn survey(
    project: &Fixture,
    programs: &Path,
    environment: &[(&str, &Path)],
    arguments: &[&str],
) -> (Outcome, Value, String) {
    let tool = programs.join(format!("chapters{EXE_SUFFIX}"));
    let cards = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new(tool);
    command.arg("survey").args(arguments).arg("--out").arg(cards.path());
    command.arg("--root").arg(project.path("")).envs(environment.iter().copied());
    let outcome = run(&mut command);
    let mut files: Vec<_> = cards
        .path()
        .read_dir()
        .expect("a folder")
        .map(|file| file.expect("a file").path())
        .collect();
    files.sort();
    let [json, md] = &files[..] else { panic!("{files:?}: {}{}", outcome.out, outcome.err) };
    let read = |path: &Path| fs::read_to_string(path).expect("a card");
    let (text, sheet) = (read(json), read(md));
    for private in [project.path(""), programs.to_owned(), std::env::temp_dir()] {
        let private = private.to_str().expect("UTF-8");
        assert!(!text.contains(private) && !sheet.contains(private), "{private}: {text}{sheet}");
    }
    (outcome, serde_json::from_str(&text).expect("JSON"), sheet)
}

/// The lines of a card with two failures, by chapter.
#[track_caller]
fn failures((outcome, card, sheet): (Outcome, Value, String)) -> [String; 2] {
    assert_eq!(outcome.code, 1, "{}{}", outcome.out, outcome.err);
    assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    let chapters = card["chapters"].as_array().expect("chapters");
    let lines: Vec<String> = chapters
        .iter()
        .map(|chapter| chapter["failed"].as_str().unwrap_or_default().to_owned())
        .collect();
    for line in lines.iter().filter(|line| !line.is_empty()) {
        assert!(!line.contains('\n') && outcome.out.contains(line), "{line}: {}", outcome.out);
        assert!(sheet.contains(&line.replace('|', "\\|")), "{line}: {sheet}");
    }
    lines.try_into().expect("two chapters")
}

#[test]
fn a_card_tells_what_was_run_and_fills_the_page() {
    let (project, programs) = (project(), programs(&[]));
    let (outcome, card, sheet) = survey(&project, programs.path(), &[], &["--full"]);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    let start = "2 lines to come; a program is stopped after 60 s\n[1/2] 01_one: passes, ";
    assert!(outcome.out.starts_with(start), "{}", outcome.out);
    assert!(outcome.out.contains(" ms\n[2/2] 02_basic: passes, "), "{}", outcome.out);
    let last = outcome.out.lines().last().unwrap_or_default();
    assert!(last.starts_with("Read the .md; then open an issue"), "{last}");
    let device = card["device"]["name"].as_str().expect("a device");
    assert!(sheet.starts_with(&format!("# {device}\n")), "{sheet}");
    assert!(card["device"]["vulkan"][0].as_u64() >= Some(1), "{card}");
    assert!(
        sheet.contains("\n| vendor and device | 0x") && sheet.contains("\n| limits | recursion ")
    );
    // The fixture is not a Git repository; a project that is one is identified by its commit.
    assert_eq!(card["commit"], Value::Null);
    for chapter in card["chapters"].as_array().expect("chapters") {
        assert_eq!((&chapter["failed"], &chapter["mean_flip"]), (&Value::Null, &0.0.into()));
        assert!(chapter["milliseconds"].as_f64() > Some(0.0), "{chapter}");
    }
    // The page shows the card, and check finds no fault.
    let words = device.to_lowercase();
    let words = words.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let file = format!("docs/devices/{}.json", words.collect::<Vec<_>>().join("-"));
    project.write(&file, &serde_json::to_string_pretty(&card).expect("JSON"));
    project.write("docs/devices.md", "# What was tested\n\n<!-- devices -->\n<!-- /devices -->\n");
    assert_eq!(project.run(&["sync"]).code, 0);
    let row = project.read("docs/devices.md");
    assert!(row.contains(&format!("| {device} |")) && row.contains(" | 2 of 2 | "), "{row}");
    assert_eq!(project.check(), "");
}

/// A short card has no times, and is a card all the same.
#[test]
fn a_short_card_is_one() {
    let (project, programs) = (project(), programs(&[]));
    let (outcome, card, sheet) = survey(&project, programs.path(), &[], &[]);
    let start = "2 lines to come; a program is stopped after 60 s, all after 3 minutes\n[1/2] 01_one: passes\n";
    assert!(outcome.code == 0 && outcome.out.starts_with(start), "{}{}", outcome.out, outcome.err);
    assert_eq!(
        (&card["full"], &card["chapters"][0]["milliseconds"]),
        (&Value::Bool(false), &Value::Null)
    );
    assert!(sheet.contains("| 02_basic | passes | 0.00000 | 0.00200 | 0 |\n"), "{sheet}");
    let stem = sheet.lines().next().expect("a title")[2..].to_lowercase();
    let words = stem.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let file = format!("docs/devices/{}.json", words.collect::<Vec<_>>().join("-"));
    project.write(&file, &(serde_json::to_string_pretty(&card).expect("JSON") + "\n"));
    assert_eq!(project.check(), "");
}

#[test]
fn a_broken_shader_is_a_line_of_the_card() {
    let (project, programs) = (project(), programs(&[]));
    let shaders = tempfile::tempdir().expect("a temporary folder");
    copy(&project.path("shaders"), shaders.path());
    let sky = shaders.path().join("02_basic/sky.rmiss");
    let text = fs::read_to_string(&sky).expect("a shader");
    fs::write(&sky, format!("{text}broken\n")).expect("a shader");
    let line = text.lines().count() + 1;
    for told in failures(survey(&project, programs.path(), &[("SHADERS", shaders.path())], &[])) {
        let start = format!("shader does not compile: 02_basic/sky.rmiss:{line}");
        assert!(told.starts_with(&start), "{told}");
    }
}

#[test]
fn a_missing_driver_is_told_once_before_anything_runs() {
    let (project, programs) = (project(), programs(&[]));
    let tool = programs.path().join(format!("chapters{EXE_SUFFIX}"));
    let cards = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new(tool);
    command.arg("survey").arg("--out").arg(cards.path()).arg("--root").arg(project.path(""));
    let nowhere = "/nonexistent";
    let outcome = run(command.env("VK_DRIVER_FILES", nowhere).env("VK_ICD_FILENAMES", nowhere));
    assert_eq!((outcome.code, &*outcome.out), (1, ""), "{}", outcome.err);
    assert!(outcome.err.starts_with("error: no Vulkan driver: run ./setup"), "{}", outcome.err);
    assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    assert!(cards.path().read_dir().expect("a folder").next().is_none());
}

/// A stand-in for a card has a complete driver, which passes everything except the comparison of pictures. Intel's even
/// measures times.
#[cfg(target_os = "linux")]
#[test]
fn a_device_that_executes_nothing_is_told_once_and_gets_no_card() {
    for (card, name) in [
        ("navi31", "AMD Radeon RX 7900 XTX (RADV NAVI31)"),
        ("dg2", "Intel(R) Arc(tm) A770M Graphics (DG2)"),
    ] {
        gets_no_card(card, name);
    }
}

#[cfg(target_os = "linux")]
fn gets_no_card(card: &'static str, name: &str) {
    let Some(card) = run::cards::Card(card).environment() else { return };
    let (project, programs) = (project(), programs(&[]));
    let tool = programs.path().join("chapters");
    let cards = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new(tool);
    command.arg("survey").arg("--out").arg(cards.path()).arg("--root").arg(project.path(""));
    let outcome = run(command.envs(card));
    assert_eq!(outcome.code, 1, "{}{}", outcome.out, outcome.err);
    let line = format!("error: {name} executes nothing: every pixel of 01_one");
    assert!(outcome.err.starts_with(&line), "{}", outcome.err);
    assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    assert!(cards.path().read_dir().expect("a folder").next().is_none());
}

#[test]
fn without_the_validation_layer_pictures_are_still_held_to_golden_ones() {
    let (project, programs) = (project(), programs(&[]));
    let nowhere = Path::new("/nonexistent");
    let (outcome, card, sheet) =
        survey(&project, programs.path(), &[("VK_LAYER_PATH", nowhere)], &[]);
    assert_eq!((outcome.code, &card["validated"]), (0, &Value::Bool(false)), "{}", outcome.err);
    assert!(sheet.contains("| validation | not installed |"), "{sheet}");
}

#[cfg(unix)]
#[test]
fn lost_devices_crashes_and_hangs_are_lines_of_the_card() {
    let lost = "echo 'error: the device is lost: ERROR_DEVICE_LOST' >&2; exit 1";
    for (scripts, told) in [
        (
            [("01_one", lost), ("02_basic", "kill -SEGV $$")],
            ["the device is lost: ERROR_DEVICE_LOST", "crashed (SIGSEGV)"],
        ),
        (
            [("01_one", "exec sleep 100"), ("02_basic", "exit 3")],
            ["stopped after 1 s without an end", "exit status: 3"],
        ),
    ] {
        let (project, programs) = (project(), programs(&scripts));
        assert_eq!(failures(survey(&project, programs.path(), &[], &["--limit", "1"])), told);
    }
}

#[test]
fn a_picture_that_differs_and_one_that_is_missing_are_lines_of_the_card() {
    let (project, programs) = (project(), programs(&[]));
    let [one, basic] = ["01_one", "02_basic"].map(|name| format!("tests/golden/{name}.png"));
    let mut picture = image::open(project.path(&one)).expect("a picture").to_rgb8();
    picture.iter_mut().for_each(|channel| *channel = 255 - *channel);
    picture.save(project.path(&one)).expect("a picture");
    project.remove(&basic);
    let [differs, missing] = failures(survey(&project, programs.path(), &[], &[]));
    assert!(
        differs.starts_with("its picture differs: mean FLIP 0.")
            && differs.ends_with("above 0.002")
    );
    assert_eq!(missing, "its golden picture is missing");
}

#[test]
fn a_device_that_is_not_there_is_refused_before_anything_runs() {
    let (project, programs) = (project(), programs(&[]));
    let tool = programs.path().join(format!("chapters{EXE_SUFFIX}"));
    let cards = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new(tool);
    command.args(["survey", "--device", "no such card", "--out"]).arg(cards.path());
    let outcome = run(command.arg("--root").arg(project.path("")));
    assert_eq!((outcome.code, &*outcome.out), (2, ""), "{}", outcome.err);
    assert!(
        outcome.err.starts_with("error: no device 'no such card'; there is 0: "),
        "{}",
        outcome.err
    );
    assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    assert_eq!(cards.path().read_dir().expect("a folder").count(), 0);
}

#[test]
fn a_limit_that_is_none_is_refused() {
    let project = project();
    for wrong in ["abc", "0", "-5", "86401"] {
        let outcome = project.run(&["survey", "--limit", wrong]);
        assert_eq!((outcome.code, &*outcome.out), (2, ""), "{}", outcome.err);
        let right = "a limit is a whole number of seconds from 1 to 86400, a day";
        assert!(outcome.err.contains(right) && outcome.err.lines().count() == 1, "{}", outcome.err);
    }
}

#[test]
fn a_place_that_takes_no_card_is_refused_before_anything_runs() {
    let project = project();
    let survey = |out: &str| {
        let outcome = project.run(&["survey", "--out", out]);
        assert_eq!((&*outcome.out, outcome.err.lines().count()), ("", 1), "{}", outcome.err);
        (outcome.code, outcome.err)
    };
    let file = project.path("Cargo.toml");
    let file = file.to_str().expect("a path of letters");
    let refused = format!(
        "error: '{file}' is a file, and the card goes to a folder; name another folder with --out\n"
    );
    assert_eq!(survey(file), (2, refused.clone()));
    assert_eq!(survey(&format!("{file}/card")), (2, refused));
    if cfg!(target_os = "linux") {
        let (code, line) = survey("/proc");
        let start = "error: the card cannot go to '/proc': cannot write '/proc/card.md': ";
        assert!(code == 1 && line.starts_with(start), "{line}");
        assert!(line.ends_with("; name another folder with --out\n"), "{line}");
    }
}

/// A chapter of prices and faults, of which scripts stand in for the programs.
#[cfg(unix)]
#[test]
fn faults_of_the_driver_are_rows_of_the_card() {
    let report = "for word; do last=$word; done; case \"$*\" in *--faults*)";
    let rows =
        r#"echo '[{"what": "boxes after an update", "rays": 9, "wrong": 2}]' > "$last"; exit 1;;"#;
    let script = format!("{report} {rows} esac; exit 0");
    let (project, programs) = (project(), programs(&[("02_basic", &script)]));
    let list = project.read("Cargo.toml").replace("02_basic", "24_accuracy");
    project.write("Cargo.toml", &list);
    let of = |name: &str| programs.path().join(format!("{name}{EXE_SUFFIX}"));
    fs::rename(of("02_basic"), of("24_accuracy")).expect("a program");
    let (outcome, card, sheet) = survey(&project, programs.path(), &[], &["--risky"]);
    assert_eq!(outcome.code, 1, "{}{}", outcome.out, outcome.err);
    let row = json!({"what": "boxes after an update", "rays": 9, "wrong": 2});
    assert_eq!(card["faults"], json!([row, row]), "{}", outcome.out);
    assert!(sheet.contains("| boxes after an update | 2 of 9 rays are wrong |"), "{sheet}");
    assert!(sheet.contains("| known faults | 2 seen |"), "{sheet}");
}

/// A complete card.
const CARD: &str = r#"{
  "date": "2026-11-22", "system": "linux x86_64", "validated": true, "tolerance": 0.002,
  "device": {"name": "A card", "driver": "d", "vulkan": [1, 3, 0]},
  "chapters": [{"name": "02_basic", "mean_flip": 0.0, "milliseconds": 1.0}],
  "hard_cases": {"right": 0, "cases": 0, "missing": 0},
  "measured": {"rungs": []}
}
"#;

#[test]
fn what_is_no_card_is_refused() {
    fn send(fixture: &Fixture, from: &str, to: &str) {
        assert!(CARD.contains(from), "{from}");
        fixture.write("docs/devices/a-card.json", &CARD.replacen(from, to, 1));
    }
    let fixture = Fixture::new();
    send(&fixture, "A card", "A card");
    assert_eq!(fixture.check(), "");
    let remedy = "; send the file that cargo chapters survey wrote";
    let cases: [Case; 7] = [
        ("no JSON", |f| send(f, "{", "<"), "docs/devices/a-card.json:1: no valid card: ", remedy),
        (
            "a field that no card has",
            |f| send(f, "\"system\":", "\"user\": \"ada\", \"system\":"),
            "docs/devices/a-card.json:2: no valid card: unknown field `user`",
            remedy,
        ),
        (
            "a date that is none",
            |f| send(f, "2026-11-22", "today"),
            "docs/devices/a-card.json:1: no valid card: 'today' is no date",
            remedy,
        ),
        (
            "a chapter that is not there",
            |f| send(f, "02_basic", "99_none"),
            "docs/devices/a-card.json:1: no valid card: there is no chapter '99_none'",
            remedy,
        ),
        (
            "a chapter that passes though its picture differs",
            |f| send(f, "\"mean_flip\": 0.0", "\"mean_flip\": 0.1"),
            "docs/devices/a-card.json:1: no valid card: 02_basic passes without",
            remedy,
        ),
        (
            "a path of somebody's machine",
            |f| send(f, "\"d\"", "\"/home/ada/libvulkan.so\""),
            "docs/devices/a-card.json:1: no valid card: it holds a path",
            remedy,
        ),
        (
            "another device's name",
            |f| send(f, "A card", "B card"),
            "docs/devices/a-card.json:1: no valid card: the card of this device is b-card.json",
            remedy,
        ),
    ];
    expect(&cases, &[]);
}

#[test]
#[ignore = "by hand: takes the time of a whole survey, minutes"]
fn the_whole_survey_in_time() {
    let cards = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new(program("chapters"));
    command.arg("survey").arg("--out").arg(cards.path()).arg("--root").arg(root());
    let start = Instant::now();
    let outcome = run(&mut command);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    expected::give_timed("devices/survey", json!({ "seconds": start.elapsed().as_secs_f64() }));
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_ends_a_survey_and_nothing_is_left() {
    let (project, programs) =
        (project(), programs(&[("01_one", "echo $$ > started; exec sleep 60")]));
    let [cards, temporary] = [(); 2].map(|()| tempfile::tempdir().expect("a temporary folder"));
    // Under nohup, the test would start with a signal ignored.
    let mut command = Command::new("env");
    command.arg("--default-signal=TERM,INT,HUP").arg(programs.path().join("chapters"));
    command.args(["survey", "--out"]).arg(cards.path()).arg("--root").arg(project.path(""));
    let child = command.env("TMPDIR", temporary.path()).stdout(Stdio::null()).spawn();
    let mut child = child.expect("the tool starts");
    while !project.path("started").exists() {
        std::thread::sleep(Duration::from_millis(10));
    }
    let kill = format!("kill -TERM {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().expect("a shell").success());
    assert_eq!(child.wait().expect("an end").code(), Some(1));
    for folder in [&cards, &temporary] {
        assert!(folder.path().read_dir().expect("a folder").next().is_none());
    }
}
