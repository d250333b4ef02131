//! Errors of every kind: a sample reports each in one line and exits with 1 (failed) or 2 (wrong arguments).
//! One module for each kind of input.

mod arguments;
mod failures;
mod gltf_models;
mod hazards;
#[cfg(target_os = "linux")]
mod limits;
mod machine;
mod many;
mod models;
mod outputs;
mod own_program;
mod owners;
mod scarce;
mod scenes;
mod shaders;
mod signals;
mod silhouettes;
mod testmodels;

use std::path::Path;

/// The chapter that represents all: the tests are about the framework.
const SAMPLE: &str = "02_basic";

/// Runs [`SAMPLE`] small and headless, and checks the exit code and the words of its message.
#[track_caller]
fn refused(arguments: &[&str], code: i32, words: &[&str]) {
    let mut command = sample();
    command.args(arguments);
    refused_by(command, code, words);
}

/// As [`refused`], for a given command.
#[track_caller]
fn refused_by(mut command: std::process::Command, code: i32, words: &[&str]) {
    let (actual, line) = run::refusal(command.output().expect("the sample starts"));
    assert_eq!(actual, code, "{line}");
    for word in words {
        assert!(line.contains(word), "'{word}' is not in: {line}");
    }
    println!("{line}");
}

/// [`SAMPLE`], small and headless.
fn sample() -> std::process::Command {
    let mut command = run::command(SAMPLE);
    command.args(["--headless", "--size", "8x8"]);
    command
}

/// A path as an argument.
fn text(path: &Path) -> &str {
    path.to_str().expect("temporary folders have plain names")
}
