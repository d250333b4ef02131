//! Features of dependencies. Cargo compiles a crate again for each set of features, with all that depends on it.

use std::collections::BTreeSet;
use std::process::Command;

/// The packages of a selection, each with version and features.
fn packages(selection: &[&str]) -> BTreeSet<String> {
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--offline", "--prefix", "none", "--format", "{p} {f}"]).args(selection);
    let output = tree.current_dir(run::root()).output().expect("cargo lists packages");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("it is text");
    text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect()
}

#[test]
fn what_the_books_tool_needs_is_compiled_once_for_all() {
    let tool = packages(&["--package", "chapters", "--edges", "normal,build"]);
    let all = packages(&["--workspace", "--edges", "normal,build,dev"]);
    let other: Vec<_> = tool.difference(&all).collect();
    assert!(
        tool.len() > 100 && other.is_empty(),
        "with other features in `cargo test`: {other:#?}"
    );
}
