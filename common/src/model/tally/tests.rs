//! The memory that reading needs, compared with the estimate: each file in a process of its own.

#![cfg(target_os = "linux")]

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use super::super::limits::Limits;
use super::super::obj::load;
use super::super::obj_check::Check;
use super::super::text::{Folder, Text};

/// The path of the file for [`reads_a_model`].
const FILE: &str = "MODEL_TO_READ";

/// The line of `/proc/self/status` with this name, in bytes.
fn status(name: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() << 10
}

#[test]
#[ignore = "run by the others"]
fn reads_a_model() {
    let path = std::env::var_os(FILE).unwrap();
    let path = Path::new(&path);
    let before = status("VmRSS");
    load(path).unwrap();
    let taken = status("VmHWM") - before;
    let text = Text::read(path, String::new(), u64::MAX).unwrap();
    let check = Check::run(&text, &Folder::of(path).unwrap(), &Limits::DEFAULT).unwrap();
    println!("taken {taken} counted {}", check.counted());
}

/// The bytes needed for reading this model, and the estimate.
fn read(text: &str) -> [u64; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    std::fs::write(&path, text).unwrap();
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "model::tally::tests::reads_a_model", "--ignored", "--nocapture"]);
    let output = command.env(FILE, &path).output().unwrap();
    let output = String::from_utf8(output.stdout).unwrap();
    let number = |name: &str| {
        let mut words = output.split_whitespace().skip_while(|word| *word != name);
        words.nth(1).unwrap_or_else(|| panic!("{output}")).parse().unwrap()
    };
    ["taken", "counted"].map(number)
}

#[test]
fn no_model_takes_more_memory_than_was_counted() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let mut all = Vec::new();
    all.push(("polygons", format!("{corners}{}", "f 1 2 3 1 2 3 1 2 3 1 2 3\n".repeat(50_000))));
    all.push(("triangles", format!("{corners}{}", "f 1 2 3\n".repeat(200_000))));
    let mut grid = String::new();
    for i in 0..400 * 400 {
        writeln!(grid, "v {} {} 0", i / 400, i % 400).unwrap();
        if i % 400 > 0 && i >= 400 {
            writeln!(grid, "f -1 -2 -402 -401").unwrap();
        }
    }
    all.push(("a grid", grid));
    let mut apart = "v 0 0 0\nvt 0 0\nvn 0 0 1\n".repeat(70);
    for i in 0..70 * 70 * 70 / 3 {
        let corner = |i: usize| format!("{}/{}/{}", 1 + i % 70, 1 + i / 70 % 70, 1 + i / 4900);
        writeln!(apart, "f {} {} {}", corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)).unwrap();
    }
    all.push(("corners that differ", apart));
    all.push(("meshes", format!("{corners}{}", "o\nf 1 2 3\n".repeat(50_000))));
    let name = "n".repeat(1000);
    all.push(("long names", format!("{corners}{}", format!("o {name}\nf 1 2 3\n").repeat(20_000))));
    all.push(("positions", format!("{}f 1 2 3\n", "v 0 0 0\nvt 0\nvn 0 0 1\n".repeat(300_000))));
    for (what, text) in all {
        let [taken, counted] = read(&text);
        println!("{what}: {} bytes, {taken} taken, {counted} counted", text.len());
        // The program's own pages are included.
        assert!(taken < counted + (4 << 20), "{what}: {taken} taken, {counted} counted");
        assert!(taken > counted / 8, "{what}: {taken} taken, {counted} counted");
    }
}
