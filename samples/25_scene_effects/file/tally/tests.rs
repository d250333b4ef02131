//! Memory of reading compared with the count: each file in a process of its own.

#![cfg(target_os = "linux")]

use std::fmt::Write;
use std::process::Command;

use super::super::description::Description;
use super::super::source::Source;
use super::Tally;

/// The path of the file that [`reads_a_scene`] reads.
const FILE: &str = "SCENE_TO_READ";

/// The line of `/proc/self/status` with this name, in bytes.
fn status(name: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() << 10
}

#[test]
#[ignore = "run by the others"]
fn reads_a_scene() {
    let path = std::env::var_os(FILE).unwrap();
    let before = status("VmRSS");
    let source = Source::open(path.as_ref()).unwrap();
    // Valid or not: only the counts are tested.
    let read = source.table().and_then(|table| source.read::<Description>(table));
    let (right, taken) = (read.is_ok(), status("VmHWM") - before);
    let text = std::fs::read_to_string(path).unwrap();
    println!("right {right} taken {taken} counted {}", Tally::of(&text).unwrap().bytes());
}

/// The bytes that reading this scene takes, and those that were counted.
fn read(text: &str) -> [u64; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "file::tally::tests::reads_a_scene", "--ignored", "--nocapture"]);
    let output = command.env(FILE, &path).output().unwrap();
    let output = String::from_utf8(output.stdout).unwrap();
    let number = |name: &str| {
        let mut words = output.split_whitespace().skip_while(|word| *word != name);
        words.nth(1).unwrap_or_else(|| panic!("{output}")).parse().unwrap()
    };
    ["taken", "counted"].map(number)
}

#[test]
fn no_scene_takes_more_memory_than_was_counted() {
    let head = "version = 1\n[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfield_of_view = 40\n";
    let ball = "[[sphere]]\ncenter = [0.5, 1.25, -3]\nradius = 0.3\nmaterial = \"a\"\n";
    let lines = |count: usize, line: fn(usize) -> String| (0..count).map(line).collect::<String>();
    let mut all = vec![
        ("spheres", format!("{head}{}", ball.repeat(40_000))),
        ("keys", lines(150_000, |i| format!("k{i}=1\n"))),
        ("dots in keys", lines(6000, |i| format!("k{i}.{}a=1\n", "a.".repeat(12)))),
        ("headlines", lines(50_000, |i| format!("[a{i}.b]\n"))),
        ("tables in braces", format!("x=[{}]", "{a=0},".repeat(60_000))),
        ("empty lists", format!("x=[{}]", "[],".repeat(300_000))),
        ("short lists", format!("x=[{}]", "[0],".repeat(200_000))),
        ("one list", format!("x=[{}]", "0,".repeat(1_000_000))),
        ("escapes", format!("x=[{}]", "\"\\u0041aaaaaaaaaaaaaa\",".repeat(200_000))),
        ("comments", "#\n".repeat(1_000_000)),
    ];
    for garbage in ["]", "=", "[", ".", "{", "a ", "[a]b=1,", "\"\n"] {
        all.push((garbage, garbage.repeat(500_000)));
    }
    let mut text = String::new();
    for (what, scene) in all {
        let [taken, counted] = read(&scene);
        writeln!(text, "{what:?}: {} bytes, {taken} taken, {counted} counted", scene.len())
            .unwrap();
        // The program's own pages are among what is taken.
        assert!(taken < counted + (4 << 20), "{text}");
    }
    println!("{text}");
}
