//! An X server without a screen.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// Starts a server on a free display with additional arguments; returns the display's name.
pub fn start(more: &[&str]) -> (Child, String) {
    let mut command = Command::new("Xvfb");
    command.args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"]);
    command.args(more);
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
    let mut child = child.unwrap_or_else(|error| panic!("no Xvfb ({error}): run ./setup --tests"));
    let mut number = String::new();
    let output = child.stdout.take().expect("piped");
    BufReader::new(output).read_line(&mut number).expect("Xvfb tells its display");
    (child, format!(":{}", number.trim()))
}
