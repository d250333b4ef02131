//! A small project of two chapters in a temporary folder, without any fault.
//!
//! Both chapters' programs are copies of `02_basic`, so its pictures and tables are real.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use run::{copy, program, root};
use tempfile::TempDir;

/// A project on disk, removed with its last user.
pub struct Fixture {
    folder: TempDir,
}

/// The outcome of a run of the tool.
pub struct Outcome {
    /// The exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error without the messages about waiting, which depend on the machine.
    pub err: String,
    /// The messages about waiting.
    pub waits: Vec<String>,
}

/// The tool and the two programs, in a folder of their own.
static PROGRAMS: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (sample, tool) = (program("02_basic"), program("chapters"));
    for (program, name) in [(&sample, "01_one"), (&sample, "02_basic"), (&tool, "chapters")] {
        fs::copy(program, folder.path().join(format!("{name}{EXE_SUFFIX}"))).expect("a program");
    }
    folder
});

/// The project that every test copies: filled in once, with its pictures.
static WHOLE: LazyLock<Fixture> = LazyLock::new(|| {
    let fixture = Fixture { folder: tempfile::tempdir().expect("a temporary folder") };
    for (path, text) in FILES {
        fixture.write(path, text);
    }
    let real = root();
    for folder in ["samples/02_basic", "shaders/02_basic"] {
        copy(&real.join(folder), &fixture.path(folder));
    }
    // Of the common shaders only the included ones: the others would be strays.
    let mut open = files(&fixture.path("shaders"));
    while let Some(file) = open.pop() {
        let text = fs::read_to_string(file).expect("a shader");
        for name in text.lines().filter_map(|line| line.strip_prefix("#include \"")) {
            let name = name.trim_end_matches('"').trim_start_matches("common/");
            let path = format!("shaders/common/{name}");
            if real.join(&path).exists() && !fixture.path(&path).exists() {
                fixture.write(&path, &fs::read_to_string(real.join(&path)).expect("a shader"));
                open.push(fixture.path(&path));
            }
        }
    }
    let outcome = fixture.run(&["sync", "--pictures"]);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    for name in ["01_one", "02_basic"] {
        fixture.write(&format!("tests/golden/{name}.png"), "only that it exists counts");
    }
    fixture
});

impl Fixture {
    /// A copy of the whole project.
    pub fn new() -> Self {
        let fixture = Self { folder: tempfile::tempdir().expect("a temporary folder") };
        copy(&WHOLE.path(""), &fixture.path(""));
        fixture
    }

    /// The path of a file of the project.
    pub fn path(&self, path: &str) -> PathBuf {
        self.folder.path().join(path)
    }

    /// A file's text.
    pub fn read(&self, path: &str) -> String {
        fs::read_to_string(self.path(path)).expect("a file of the fixture")
    }

    /// Writes a file, and its folder.
    pub fn write(&self, path: &str, text: &str) {
        let path = self.path(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    }

    /// Replaces a text that must occur in a file.
    pub fn replace(&self, path: &str, from: &str, to: &str) {
        let text = self.read(path);
        assert!(text.contains(from), "'{from}' is not in {path}: {text}");
        self.write(path, &text.replacen(from, to, 1));
    }

    /// Removes a file.
    pub fn remove(&self, path: &str) {
        fs::remove_file(self.path(path)).expect("a file of the fixture");
    }

    /// The tool, in the folder of the project's programs.
    pub fn tool(&self) -> PathBuf {
        PROGRAMS.path().join(format!("chapters{EXE_SUFFIX}"))
    }

    /// Runs the tool on the project.
    pub fn run(&self, arguments: &[&str]) -> Outcome {
        run(&mut self.command(arguments))
    }

    /// A command that runs the tool on the project.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(self.tool());
        command.args(arguments).arg("--root").arg(self.path(""));
        command
    }

    /// Output of `check`: empty if there is no fault.
    pub fn check(&self) -> String {
        let outcome = self.run(&["check"]);
        assert_eq!(outcome.code, i32::from(!outcome.out.is_empty()), "{}", outcome.err);
        outcome.out
    }
}

/// Runs a command to its end.
pub fn run(command: &mut Command) -> Outcome {
    let output = command.output().expect("the tool starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    let code = output.status.code().expect("an exit code");
    let said = text(output.stderr);
    let (waits, err): (Vec<&str>, Vec<&str>) =
        said.split_inclusive('\n').partition(|line| line.starts_with("waiting: "));
    let waits = waits.iter().map(|line| line.trim_end().to_owned()).collect();
    Outcome { code, out: text(output.stdout), err: err.concat(), waits }
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let below = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    entries(folder).into_iter().flat_map(below).collect()
}

/// The files that are not copied from the real project.
const FILES: [(&str, &str); 16] = [
    (
        "Cargo.toml",
        r#"[package]
name = "fixture"
default-run = "02_basic"

[[bin]]
name = "01_one"
path = "samples/01_one/main.rs"

[[bin]]
name = "02_basic"
path = "samples/02_basic/main.rs"

[[bin]]
name = "chapters"
path = "docs/chapters/main.rs"

[[test]]
name = "samples"
path = "tests/samples/main.rs"

[package.metadata.chapters.01_one]
title = "One"
teaches = "the first thing"

[package.metadata.chapters.02_basic]
title = "Basic"
teaches = "the second thing"
from = "01_one"
"#,
    ),
    ("README.md", "# Fixture\n\n<!-- gallery -->\n<!-- /gallery -->\n"),
    (
        "samples/01_one/main.rs",
        r#"//! 01 · One: the first thing.

fn main() {
    // ANCHOR: call
    let name = "01_one";
    run(name); // ünïcode → 漢字
    // ANCHOR_END: call
}
// Names "one.rgen".
"#,
    ),
    (
        "shaders/01_one/one.rgen",
        "#version 460\n// ANCHOR: only\nvoid main() {\n    // first\n}\n// ANCHOR_END: only\n",
    ),
    (
        "docs/01_one.md",
        r#"# 01 · One
All of it is exact, and costs nothing.
![The picture](images/01_one.png)

<!-- picture -->
```sh
cargo run --bin 01_one -- --headless --size 48x30 \
    --out one.png
```

Its call:

<!-- snippet samples/01_one/main.rs#call -->
<!-- /snippet -->

See [the next chapter](02_basic.md) and [the code](../samples/01_one/main.rs).

## Notes

Chapter 02 goes on, chapter 03 (planned) ends it. `main.rs` calls, `shaders/01_one/one.rgen:2` begins, and
`shaders/01_one/one.rgen#only` shows it. `NN_name` is 01_one or `02_basic`. See [the notes](#notes).

| what | X-ray |
|---|---|
| a ULP | half |

## Try it

<!-- exercises 01_one -->
<!-- /exercises -->

## Sources

- A. Nobody, *Another Book*, chapter 17.
"#,
    ),
    (
        "docs/02_basic.md",
        r#"# 02 · Basic
All of it is exact, and costs nothing.
<!-- picture -->
```sh
cargo run --bin 02_basic -- --headless --size 32x20 --out basic.png
```

<!-- diff 01_one 02_basic -->
<!-- /diff -->

<!-- controls 02_basic -->
<!-- /controls -->

All chapters share `band.glsl`, `camera.glsl`, `extensions.glsl`, `scene.glsl` and `shade.glsl`.

Compare them with `cargo chapters diff 01 02`, list what `cargo run --bin NN_name` can do.

## Try it

<!-- exercises 02_basic -->
<!-- /exercises -->
"#,
    ),
    (
        "docs/exercises/01.1.diff",
        r#"Change the shader

Takes: shader, test
Text: Change `one.rgen`.
Check: `cargo test --test samples basic::first` fails.
Hint: The test reads it.
Minutes: 5
Run: (test) basic::first
Expect: fails

--- shaders/01_one/one.rgen
+++ shaders/01_one/one.rgen
@@ -4,1 +4,1 @@
-    // first
+    // second
"#,
    ),
    (
        "docs/exercises/01.2.diff",
        r#"Think of another

Takes: look
Text: Write `two.rgen` after exercise 1. Is there a file `two.rgen` now, yes or no?
Check: yes: `two.rgen` is there.
Hint: You have written it.
Choices: yes | no
Answer: yes
Minutes: 2
"#,
    ),
    (
        "docs/exercises/02.1.diff",
        r#"Make it white

Takes: shader
Text: Let `camera.rgen` write white.
Check: The picture is white, all 1,500 pixels of it.
Hint: White is `vec4(1.0)`.
Run: --size 50x30
Expect: as the solution
Expect: pixels 255 255 255: 1500
Why: The picture is what is stored.
Minutes: 1

--- shaders/02_basic/camera.rgen
+++ shaders/02_basic/camera.rgen
@@ -1 +1 @@
-    imageStore(picture, ivec2(id), payload);
+    imageStore(picture, ivec2(id), vec4(1.0));
"#,
    ),
    (
        "docs/exercises/02.2.diff",
        r#"Look at a normal

Takes: look
Text: `--set show=normal` colours by normal. Which way does a green face look, up or down?
Check: It looks up.
Hint: Green is y.
Run: --set show=normal --size 50x30
Expect: differs by 0.05 from --size 50x30
Choices: down | up
Answer: up
Minutes: 2
"#,
    ),
    (
        "docs/exercises/02.3.diff",
        r#"Name it anew

Takes: Rust
Text: Give the name to the compiler.
Check: The same picture to the bit.
Hint: There is a macro.
Run: --size 50x30
Expect: same
Minutes: 10

--- samples/01_one/main.rs
+++ samples/01_one/main.rs
@@ -5 +5 @@
-    let name = "01_one";
+    let name = env!("CARGO_BIN_NAME");
"#,
    ),
    ("docs/chapters/main.rs", "fn main() {}\n"),
    ("tests/samples/main.rs", "mod basic;\nmod golden;\nmod one;\n"),
    ("tests/samples/golden.rs", "golden! {\n    basic,\n    one,\n}\n"),
    ("tests/samples/one.rs", "const GOLDEN: &str = \"01_one\";\n"),
    ("tests/samples/basic.rs", "const GOLDEN: &str = \"02_basic\";\n\n#[test]\nfn first() {}\n"),
];
