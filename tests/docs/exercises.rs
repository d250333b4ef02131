//! Exercises: their claims are true, and the tool sets them up, checks them and preserves a reader's edits.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::fixture::{Fixture, Outcome, run};

/// The tool on the real book.
fn tool(arguments: &[&str]) -> Outcome {
    run(Command::new(env!("CARGO_BIN_EXE_chapters")).arg("exercise").args(arguments))
}

/// The exercises of the real book, each with the kind of work it needs.
fn exercises() -> Vec<(String, String)> {
    let list = tool(&["--list"]);
    assert_eq!(list.code, 0, "{}", list.err);
    let words = |line: &str| {
        let (name, rest) = line.split_once(' ').expect("a name");
        let takes = rest.trim_start().split("  ").next().expect("what it takes");
        (name.to_owned(), takes.to_owned())
    };
    list.out.lines().map(words).collect()
}

/// Returns whether built programs are enough to prove it: no test, no Rust.
fn is_quick(takes: &str) -> bool {
    ["look", "shader"].contains(&takes)
}

fn prove(names: &[&str]) {
    let outcome = tool(&[names, &["--prove"]].concat());
    assert_eq!(outcome.code, 0, "\n{}{}", outcome.out, outcome.err);
    assert_eq!(outcome.out.lines().count(), names.len());
}

/// The chapters whose first shader exercise is proved by day. `chapters check` makes sure that every patch
/// applies.
const BY_DAY: [&str; 2] = ["02", "08"];

/// A few exercises, and those edited since the last commit.
#[test]
fn exercises_are_unsolved_before_their_solution_and_solved_after() {
    let all = exercises();
    let chapter = |name: &str| name.split_once('.').expect("a point").0.to_owned();
    let changed = ::run::changed();
    let edited = |name: &str| {
        let shaders = format!("shaders/{}_", chapter(name));
        let own = format!("docs/exercises/{name}.diff");
        changed.iter().any(|file| file.starts_with(&shaders) || *file == own)
    };
    let first = |name: &str| {
        let mut of_chapter = all.iter().filter(|(other, _)| chapter(other) == chapter(name));
        of_chapter.find(|(_, takes)| takes == "shader").is_some_and(|(first, _)| first == name)
    };
    let by_day = |name: &str| BY_DAY.contains(&&*chapter(name)) && first(name);
    let chosen =
        all.iter().filter(|(name, takes)| is_quick(takes) && (by_day(name) || edited(name)));
    let names: Vec<&str> = chosen.map(|(name, _)| &**name).collect();
    assert!(names.len() >= BY_DAY.len(), "{names:?}");
    prove(&names);
}

/// As on another device: each pipeline has its own errors, so no two have the same bits.
#[test]
fn two_ways_to_the_same_picture_may_round_as_they_like() {
    if !::run::has_worst_arithmetic() {
        return;
    }
    let proved = |seed: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_chapters"));
        run(command.args(["exercise", "16.1", "--prove"]).env("ARITHMETIC_SEED", seed))
    };
    let outcome = proved("1");
    assert_eq!(outcome.out, "16.1: its answer holds\n", "{}", outcome.err);
}

#[test]
#[ignore = "nightly: Rust exercises and those that run tests are built; quick: exercises::exercises_are_unsolved_before_their_solution_and_solved_after"]
fn every_exercise_is_unsolved_before_its_solution_and_solved_after() {
    let all = exercises();
    prove(&all.iter().map(|(name, _)| &**name).collect::<Vec<_>>());
}

#[test]
fn an_exercise_that_is_none_is_named_with_its_line() {
    let fixture = Fixture::new();
    let file = "docs/exercises/02.1.diff";
    let whole = fixture.read(file);
    for (from, to, expected) in [
        ("Takes: shader\n", "", "1: there is no field 'Takes'; write a title"),
        (
            "Takes: shader",
            "Takes: time",
            "3: an exercise takes no 'time'; write look, shader, file or Rust",
        ),
        (
            "Takes: shader",
            "Takes: Rust",
            "3: the diff changes shaders alone; write `Takes: shader`",
        ),
        (
            "Takes: shader",
            "Takes: file",
            "3: the diff changes shaders alone; write `Takes: shader`",
        ),
        (
            "Takes: shader",
            "Takes: look",
            "3: what takes only looking asks a question; add `Answer: …`",
        ),
        ("Why:", "Answer: white\nWhy:", "3: what is solved by a diff has no answer; remove it"),
        ("Minutes: 1", "", "1: there is no field 'Minutes'; write a title"),
        ("Minutes: 1", "Minutes: few", "11: 'few' is no number of minutes; write a whole number"),
        (
            "Minutes:",
            "Same: 1.0 gone because x\nMinutes:",
            "11: '1.0 gone because x' does not say which variant is the same; write `Same: 2.0",
        ),
        ("Hint:", "Help:", "1: there is no field 'Hint'; write a title"),
        ("Hint:", "Text: x\nHint:", "6: the field 'Text' stands here a second time; remove one"),
        ("Why:", "Who:", "10: 'Who' is no field of an exercise; write a title"),
        ("Run: --size 50x30\n", "", "7: nothing is run above this; write `Run: …` first"),
        (
            "Run: --size",
            "Run: \"--size",
            "7: '\"--size 50x30' is no run; write the program's arguments",
        ),
        ("50x30", "50x30 --out a.png", "7: --out is added to every run; remove it"),
        ("as the solution", "is white", "8: 'is white' is no expectation; write as the solution"),
        (
            "as the solution",
            "passes",
            "8: 'passes' does not belong to this run; of tests it is `passes`",
        ),
        ("Make it white\n", "\n", "1: there is no title; write a title"),
        ("Takes: shader", "takes it", "3: 'takes it' is no field; write a title"),
        (
            "shaders/02_basic/camera",
            "samples/02_basic/camera",
            "3: the diff changes more than shaders; ",
        ),
    ] {
        fixture.write(file, &whole.replace(from, to));
        let outcome = fixture.run(&["exercise", "--list"]);
        assert_eq!((outcome.code, &*outcome.out), (1, ""), "{to}");
        let start = format!("error: {file}:{expected}");
        assert!(outcome.err.starts_with(&start), "{from} as {to}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    fixture.write(file, &whole);
    // For an exercise without edits, the reader sees the first run.
    let look = "docs/exercises/02.2.diff";
    let text = fixture.read(look);
    fixture.write(
        look,
        &text
            .replace("Choices: down | up\nAnswer: up", "Answer: 45 to 55")
            .replace("50x30", "50x30 --frames 50"),
    );
    let told = fixture.run(&["exercise", "--list"]).err;
    let line =
        "3: the first run, which a reader is shown, holds the answer: 50; begin with another run";
    assert_eq!(told, format!("error: {look}:{line}\n"));
    for (from, to, what) in [
        ("Answer: up", "Answer: north", "10: `Choices` does not list the answer 'north'; correct"),
        ("down | up", "up", "10: `Choices` lists 1, not two to four; correct"),
        ("down | up", "north | up", "10: the question does not name the choice 'north'; correct"),
        (
            "Choices: down | up\n",
            "",
            "9: 'up' is not a number, and no `Choices` are listed; correct",
        ),
    ] {
        fixture.write(look, &text.replace(from, to));
        let told = fixture.run(&["exercise", "--list"]).err;
        assert!(told.starts_with(&format!("error: {look}:{what}")), "{told}");
    }
    fixture.write(look, &text);
    for (file, what) in [
        ("docs/exercises/07.1.diff", "1: there is no chapter 07; rename it"),
        ("docs/exercises/notes.txt", "1: an exercise is a file NN.k.diff; rename it"),
    ] {
        fixture.write(file, &whole);
        let outcome = fixture.run(&["exercise", "--list"]);
        assert_eq!(outcome.err, format!("error: {file}:{what}\n"));
        fixture.remove(file);
    }
}

#[test]
fn a_wrong_file_stops_its_own_exercise_alone() {
    let fixture = Fixture::new();
    let file = "docs/exercises/02.2.diff";
    fixture.write(file, &fixture.read(file).replace("Takes: look", "Takes: time"));
    let hint = fixture.run(&["exercise", "02.1", "--hint"]);
    assert_eq!(hint.code, 0, "{}", hint.err);
    for name in ["02.2", "02"] {
        let outcome = fixture.run(&["exercise", name, "--hint"]);
        assert!(outcome.err.starts_with(&format!("error: {file}:")), "{name}: {}", outcome.err);
    }
}

#[test]
fn an_exercise_that_is_not_what_its_file_claims_is_refused() {
    let fixture = Fixture::new();
    let file = "docs/exercises/02.1.diff";
    let prove = |name| fixture.run(&["exercise", name, "--prove"]);
    let outcome = prove("02.1");
    let solved = "02.1: yours is darker than the target in 1500 of 1500 pixels with --size 50x30; \
         solved by its solution\n";
    assert_eq!((outcome.code, &*outcome.out), (0, solved), "{}", outcome.err);
    assert_eq!(prove("02.2").out, "02.2: its answer holds\n");
    let whole = fixture.read(file);
    for (from, to, end) in [
        (
            "Expect: as the solution\nExpect: pixels 255 255 255: 1500\n",
            "Expect: same\n",
            "solved before its solution",
        ),
        (
            "vec4(1.0));",
            "vec4(0.9));",
            "not solved by its solution: 0 pixels are [255, 255, 255], not 1500",
        ),
        (
            "vec4(1.0));",
            "white);",
            "the solution has no picture: shader does not compile: 02_basic/camera.rgen:",
        ),
    ] {
        fixture.write(file, &whole.replace(from, to));
        let outcome = prove("02.1");
        assert_eq!(outcome.code, 1, "{}", outcome.out);
        let start = format!("{file}: {end}");
        assert!(outcome.out.starts_with(&start), "{to}: {}", outcome.out);
        assert_eq!(outcome.err, "error: 1 of 1 exercises are not what their files say\n");
    }
    fixture.replace(
        "docs/exercises/02.2.diff",
        "show=normal --size 50x30\nE",
        "show=picture --size 50x30\nE",
    );
    assert!(prove("02.2").out.contains("its answer does not hold: no pixel differs"));
}

#[test]
fn a_readers_copy_is_checked_and_never_overwritten() {
    let fixture = Fixture::new();
    let ask = |words: &[&str]| fixture.run(&[&["exercise", "02.1"], words].concat());
    let unsolved = "error: 02.1 is not solved yet: yours is darker than the target in 1500 of 1500 pixels \
                    with --size 50x30: yours target/exercises/02.1.png, where they differ \
                    target/exercises/02.1.other.png";
    // The target would give the solution away, so the reader has to try first.
    let target = ask(&["--target"]);
    let early = "error: the target of 02.1 is shown once two attempts have failed, not after 0\n";
    assert_eq!((target.code, &*target.err), (1, early));
    for offer in ["\n", "; --target shows the target of 02.1\n"] {
        let outcome = ask(&["--check"]);
        assert_eq!((outcome.code, &*outcome.err), (1, &*format!("{unsolved}{offer}")));
        assert!(!fixture.path("target/exercises/02.1.target.png").exists());
    }
    let target = ask(&["--target"]);
    let shown = "target/exercises/02.1.target.png: the target with --size 50x30\n";
    assert_eq!((target.code, &*target.out), (0, shown), "{}", target.err);
    assert!(fixture.path("target/exercises/02.1.target.png").is_file());
    for picture in ["02.1.png", "02.1.other.png"] {
        let picture = fixture.path("target/exercises").join(picture);
        assert!(picture.is_file(), "{} is not kept", picture.display());
    }
    let camera = "target/exercises/02.1/02_basic/camera.rgen";
    // A partial edit.
    fixture.replace(camera, "payload);", "payload; // half");
    let outcome = ask(&["--check"]);
    let start = "error: 02.1 is not solved yet: shader does not compile: 02_basic/camera.rgen:";
    assert!(outcome.code == 1 && outcome.err.starts_with(start), "{}", outcome.err);
    assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    // The edit is continued, and the solution no longer applies to it.
    let outcome = ask(&["--solution", "--apply"]);
    let misfit = "error: the solution does not fit shaders/02_basic/camera.rgen in target/exercises/02.1 any \
                  more: undo what you have changed there, or delete it to begin anew\n";
    assert_eq!((outcome.code, &*outcome.err), (1, misfit));
    fixture.replace(camera, "payload; // half", "vec4(1.0)); // mine");
    let outcome = ask(&["--check"]);
    let solved = "02.1 is solved.\nCheck: The picture is white, all 1,500 pixels of it.\n\
                  Why: The picture is what is stored.\n";
    assert_eq!((outcome.code, &*outcome.out), (0, solved), "{}", outcome.err);
    assert!(fixture.read(camera).contains("// mine"));
    // The book's own shaders are unchanged.
    assert!(fixture.read("shaders/02_basic/camera.rgen").contains("payload);"));
}

/// A script stands in for Cargo.
#[test]
#[cfg(unix)]
fn who_waits_is_told_for_what() {
    use std::os::unix::fs::PermissionsExt;
    let fixture = Fixture::new();
    let cargo = fixture.path("cargo");
    fs::write(&cargo, "#!/bin/sh\nsleep 2\necho error: no >&2\nexit 1\n").expect("a script");
    fs::set_permissions(&cargo, fs::Permissions::from_mode(0o755)).expect("it may be run");
    for (name, what) in [
        ("02.3", "waiting: building 02_basic"),
        (
            "01.1",
            "waiting: building all programs and the tests of samples, minutes if they are not built yet",
        ),
    ] {
        let outcome = run(fixture.command(&["exercise", name, "--check"]).env("CARGO", &cargo));
        assert_eq!(outcome.code, 1, "{}", outcome.err);
        assert!(outcome.waits.iter().any(|wait| wait == what), "{:?}", outcome.waits);
    }
}

/// A program that is killed when its test ends, even if the test fails.
struct Started(Child);

impl Drop for Started {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn each_save_is_checked_until_the_exercise_is_solved() {
    let fixture = Fixture::new();
    let mut command = Command::new(fixture.tool());
    command.args(["exercise", "02.1", "--headless", "--root"]).arg(fixture.path(""));
    let mut child = Started(command.stdout(Stdio::piped()).spawn().expect("the tool starts"));
    let mut lines = BufReader::new(child.0.stdout.take().expect("its output")).lines();
    let mut next = || lines.next().map(|line| line.expect("UTF-8")).unwrap_or_default();
    let mut told = Vec::new();
    let camera = "target/exercises/02.1/02_basic/camera.rgen";
    loop {
        let line = next();
        assert!(told.len() < 20, "{told:#?}");
        let first = line.starts_with("not yet: ");
        told.push(line);
        if first {
            break;
        }
    }
    assert_eq!(told[0], "02.1 · Make it white (shader, 1 minute)");
    let edit =
        "Edit in target/exercises/02.1, a copy of the shaders: 02_basic/camera.rgen (void main)";
    assert!(told.iter().any(|line| line == edit), "{told:#?}");
    let render = "Make it yourself: SHADERS=target/exercises/02.1 cargo run --bin 02_basic -- --size 50x30 \
                  --headless --out target/exercises/02.1.png";
    assert!(told.iter().any(|line| line == render), "{told:#?}");
    // The check's text is printed with the verdict, once the exercise is solved.
    assert!(!told.iter().any(|line| line.contains("Check:")), "{told:#?}");
    let last = told.last().expect("a line");
    let first = "not yet: yours is darker than the target in 1500 of 1500 pixels with";
    assert!(last.starts_with(first), "{last}");
    fixture.replace(camera, "payload);", "payload) // half");
    let line = next();
    assert!(line.starts_with("not yet: shader does not compile: 02_basic/camera.rgen:"), "{line}");
    fixture.replace(camera, "payload) // half", "vec4(0.9));");
    let pixels = "not yet: yours is darker than the target in 1500 of 1500 pixels with \
                  --size 50x30: yours target/exercises/02.1.png, where they differ \
                  target/exercises/02.1.other.png; --target shows the target of 02.1";
    assert_eq!(next(), pixels);
    assert!(fixture.path("target/exercises/02.1.other.png").is_file());
    fixture.replace(camera, "vec4(0.9)", "vec4(1.0)");
    assert_eq!(next(), "02.1 is solved.");
    assert!(child.0.wait().expect("an end").success());
    let list = fixture.run(&["exercise", "02"]).out;
    assert!(
        list.starts_with("02.1  shader         1 min  solved  Make it white\n02.2  look "),
        "{list}"
    );
}

#[test]
#[cfg(target_os = "linux")]
fn a_signal_ends_the_tool_and_the_window_that_it_has_opened() {
    use std::io::Read;
    use std::os::unix::fs::PermissionsExt;
    let fixture = Fixture::new();
    let signal = |what: &str, id: u32| {
        let kill = format!("kill -{what} {id} 2> /dev/null");
        Command::new("sh").args(["-c", &kill]).status().expect("a shell").success()
    };
    // Instead of the chapter, a program that runs until it is closed.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [tool, window, id] = ["chapters", "02_basic", "id"].map(|name| folder.path().join(name));
    fs::copy(fixture.tool(), &tool).expect("a copy of the tool");
    let script =
        format!("#!/bin/sh\necho $$ > {0}.new\nmv {0}.new {0}\nexec sleep 60\n", id.display());
    fs::write(&window, script).expect("a program");
    fs::set_permissions(&window, fs::Permissions::from_mode(0o755)).expect("a program");
    for what in ["TERM", "INT", "HUP"] {
        let _ = fs::remove_file(&id);
        // Under nohup, the test would start with a signal ignored.
        let mut command = Command::new("env");
        command.arg("--default-signal=TERM,INT,HUP").arg(&tool);
        command.args(["exercise", "02.2", "--root"]).arg(fixture.path("")).env("DISPLAY", ":0");
        let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let mut child = Started(child.expect("the tool starts"));
        let opened = loop {
            match fs::read_to_string(&id) {
                Ok(text) => break text.trim().parse().expect("a number"),
                Err(_) => std::thread::sleep(std::time::Duration::from_millis(10)),
            }
        };
        assert!(signal("0", opened) && signal(what, child.0.id()));
        let mut said = String::new();
        let mut errors = child.0.stderr.take().expect("its errors");
        errors.read_to_string(&mut said).expect("UTF-8");
        assert_eq!(said, "error: stopped by a signal\n", "{what}");
        assert_eq!(child.0.wait().expect("an end").code(), Some(1));
        assert!(!signal("0", opened), "{what} leaves the window open");
    }
}

#[test]
fn hints_solutions_and_answers_are_given() {
    let fixture = Fixture::new();
    let ask = |words: &[&str]| fixture.run(&[&["exercise"], words].concat());
    assert_eq!(ask(&["02.1", "--hint"]).out, "White is `vec4(1.0)`.\n");
    let solution = ask(&["basic.1", "--solution"]).out;
    assert!(solution.starts_with("--- shaders/02_basic/camera.rgen\n+++"), "{solution}");
    assert!(solution.ends_with("+    imageStore(picture, ivec2(id), vec4(1.0));\n\nCheck: The picture is white, all 1,500 pixels of it.\n\nWhy: The picture is what is stored.\n"), "{solution}");
    assert_eq!(
        ask(&["02.1", "--solution", "--apply"]).out,
        "shaders/02_basic/camera.rgen: changed\n"
    );
    assert_eq!(ask(&["02.1", "--check"]).code, 0);
    assert_eq!(ask(&["2.2", "--solution"]).out, "Answer: up\nCheck: It looks up.\n");
    let told = ask(&["02.2", "--headless"]).out;
    assert!(
        told.contains("cargo run --bin 02_basic -- --set show=normal --headless --out "),
        "{told}"
    );
    let wrong = ask(&["02.2", "--answer", "down"]);
    assert_eq!((wrong.code, &*wrong.err), (1, "error: 'down' is not the answer; --hint helps\n"));
    assert_eq!(ask(&["02.2", "--check"]).code, 1);
    let right = ask(&["02.2", "--answer", "Up"]);
    assert_eq!((right.code, &*right.out), (0, "Right: It looks up.\n02.2 is solved.\n"));
    assert_eq!(ask(&["02.2", "--check"]).code, 0);
}

#[test]
fn an_authors_edits_become_an_exercises_diff() {
    let fixture = Fixture::new();
    let file = "docs/exercises/02.4.diff";
    // From a copy of the shaders.
    let copy = fixture.path("mine");
    run::copy(&fixture.path("shaders"), &copy);
    let folder = copy.to_str().expect("a path").to_owned();
    let make = |more: &[&str]| fixture.run(&[&["exercise", "02.4", "--make"], more].concat());
    let outcome = make(&["--folder", &folder]);
    assert_eq!((outcome.code, &*outcome.out), (1, ""), "{}", outcome.err);
    assert!(outcome.err.contains("are the book's: make the solution there first"));
    fixture.replace("mine/02_basic/camera.rgen", "payload);", "0.5 * payload);");
    fixture.write("mine/02_basic/half.glsl", "// Half.\n");
    let outcome = make(&["--folder", &folder]);
    let told = format!("{file}\n\nNext:\ncargo chapters exercise 02.4 --prove\n");
    assert_eq!((outcome.code, &*outcome.out), (0, &*told), "{}", outcome.err);
    let text = fixture.read(file);
    for part in [
        "WRITE a title\n\nTakes: shader\n",
        "\n--- shaders/02_basic/camera.rgen\n+++ shaders/02_basic/camera.rgen\n@@ -",
        "+    imageStore(picture, ivec2(id), 0.5 * payload);\n",
        "--- /dev/null\n+++ shaders/02_basic/half.glsl\n@@ -0,0 +1 @@\n+// Half.\n",
    ] {
        assert!(text.contains(part), "no '{part}' in:\n{text}");
    }
    // It is an exercise, and the missing text is reported.
    let solution = fixture.run(&["exercise", "02.4", "--solution"]).out;
    assert!(solution.contains("0.5 * payload"), "{solution}");
    let write = format!("{file}:1: 'WRITE' holds a place for something");
    assert!(fixture.check().lines().any(|line| line.starts_with(&write)), "{}", fixture.check());
    // Existing text is preserved.
    fixture.replace(file, "WRITE a title", "Halve it");
    fixture.replace("mine/02_basic/camera.rgen", "0.5 *", "0.25 *");
    assert_eq!(make(&["--folder", &folder]).code, 0);
    let text = fixture.read(file);
    assert!(text.starts_with("Halve it\n\nTakes: shader\n") && text.contains("0.25 * payload"));
    assert!(!text.contains("0.5 * payload"), "{text}");
    // From the differences to the last commit.
    let git = |arguments: &[&str]| {
        let identity = ["-c", "user.name=a", "-c", "user.email=a@example.org"];
        let mut git = Command::new("git");
        let status = git.args(identity).args(arguments).current_dir(fixture.path("")).output();
        assert!(status.expect("git starts").status.success(), "{arguments:?}");
    };
    git(&["init", "--quiet"]);
    git(&["add", "--all"]);
    git(&["commit", "--quiet", "--message", "All"]);
    let outcome = make(&[]);
    assert!(outcome.err.contains("was edited since the last commit"), "{}", outcome.err);
    fixture.replace("samples/02_basic/main.rs", "fn main()", "// Mine.\nfn main()");
    fixture.write("shaders/02_basic/mine.glsl", "// Mine.\n");
    let told = format!(
        "{file}\n\nNext:\ngit restore --staged --worktree samples/02_basic/main.rs\n\
         rm shaders/02_basic/mine.glsl\ncargo chapters exercise 02.4 --prove\n"
    );
    assert_eq!(make(&[]).out, told);
    let text = fixture.read(file);
    assert!(
        text.contains("+// Mine.\n fn main()") && text.contains("+++ shaders/02_basic/mine.glsl")
    );
    for (name, words) in [("02", "is no exercise's name"), ("02.0", "is no exercise's name")] {
        let outcome = fixture.run(&["exercise", name, "--make"]);
        assert_eq!((outcome.code, outcome.err.contains(words)), (2, true), "{}", outcome.err);
    }
}

#[test]
fn the_command_that_is_told_has_the_size_of_the_text() {
    let fixture = Fixture::new();
    let told = || fixture.run(&["exercise", "02.2", "--headless"]).out;
    assert!(!told().contains("--size"), "{}", told());
    fixture.replace(
        "docs/exercises/02.2.diff",
        "`--set show=normal`",
        "`--set show=normal --size 40x30`",
    );
    assert!(told().contains("--set show=normal --size 40x30 --headless"), "{}", told());
}

#[test]
fn progress_that_is_damaged_is_told_in_a_line() {
    let fixture = Fixture::new();
    let answer = || fixture.run(&["exercise", "02.2", "--answer", "up"]);
    assert_eq!(answer().code, 0);
    let progress = "target/exercises/progress.json";
    assert_eq!(fixture.read(progress), "{\n  \"solved\": [\n    \"02.2\"\n  ]\n}\n");
    for damaged in ["", "{\"solved\": [\"02.2\"", "[]", "{\"solved\": [2]}"] {
        fixture.write(progress, damaged);
        let list = fixture.run(&["exercise", "--list"]);
        let warning = format!("warning: {progress} is damaged: what was solved is forgotten\n");
        assert_eq!((list.code, &*list.err), (0, &*warning), "{damaged}");
        assert!(!list.out.contains("solved"), "{}", list.out);
    }
    assert_eq!(answer().code, 0);
    assert!(fixture.run(&["exercise", "--list"]).out.contains("solved"));
}

#[test]
fn a_rust_exercise_keeps_the_books_pictures_before_it_is_edited() {
    let fixture = Fixture::new();
    let ask = |words: &[&str]| fixture.run(&[&["exercise", "02.3"], words].concat());
    fixture.replace("samples/01_one/main.rs", "let name", "let nom");
    let outcome = ask(&["--headless"]);
    let misfit = "error: the solution does not fit samples/01_one/main.rs: the project is not as the book has \
                  it: undo your changes and begin again\n";
    assert_eq!((outcome.code, &*outcome.err), (1, misfit));
    fixture.replace("samples/01_one/main.rs", "let nom", "let name");
    assert_eq!(ask(&["--solution", "--apply"]).out, "samples/01_one/main.rs: changed\n");
    let kept = fs::read_dir(fixture.path("target/exercises/02.3/book")).expect("a folder").count();
    assert_eq!(kept, 1);
    assert!(fixture.read("samples/01_one/main.rs").contains("env!(\"CARGO_BIN_NAME\")"));
}

#[test]
fn wrong_names_folders_and_options_are_one_line() {
    let fixture = Fixture::new();
    fixture.write("target/file", "");
    fixture.write("target/other/notes.txt", "");
    fixture.write("docs/moved.toml", "\"exercise 02.7\" = \"01.2\"\n");
    let path = |name: &str| fixture.path(name).display().to_string();
    let (file, other, below) =
        (path("target/file"), path("target/other"), path("target/file/below"));
    let cases: [(&[&str], i32, &str); 20] = [
        (&["02.7"], 2, "no exercise '02.7'; it is 01.2 now; run: cargo chapters exercise 01.2"),
        (&[], 2, "no exercise is named; --list shows them"),
        (&["09.1"], 2, "no chapter '09'; there is 01_one, 02_basic"),
        (&["02.9"], 2, "no exercise '02.9'; there is 02.1, 02.2, 02.3"),
        (&["02.x"], 2, "no exercise '02.x'; there is 02.1, 02.2, 02.3"),
        (&[".."], 2, "no chapter ''; there is"),
        (&["02", "--check"], 2, "a chapter has several exercises: name one, such as 02.1"),
        (
            &["02.1", "02.2"],
            2,
            "'02.2' is one too many: name one exercise, put an answer in quotes",
        ),
        (&["02.1", "--check", "--hint"], 2, "the argument '--check' cannot be used with '--hint'"),
        (&["02.1", "--apply"], 2, "the following required arguments were not provided"),
        (
            &["02.1", "--answer", "up"],
            2,
            "exercise 02.1 asks no question; --check tells whether it is",
        ),
        (&["02.2", "--answer", ""], 2, "'' is no answer: 02.2 takes 'down' or 'up'"),
        (&["02.2", "--answer", "not up"], 2, "'not up' is no answer: 02.2 takes 'down' or 'up'"),
        (
            &["02.2", "--solution", "--apply"],
            2,
            "exercise 02.2 changes nothing: there is nothing to apply",
        ),
        (&["02.2", "--folder", &other], 2, "exercise 02.2 changes nothing and takes no --folder"),
        (
            &["02.3", "--folder", &other],
            2,
            "exercise 02.3 is done in the project itself and takes no",
        ),
        (&["02.1", "--check", "--folder", &file], 2, "is no folder; name another with --folder"),
        (
            &["02.1", "--check", "--folder", &other],
            2,
            "holds something else than a copy of the shaders",
        ),
        (&["02.1", "--check", "--folder", &below], 2, "/file' is no folder; name another with"),
        (&["02.1", "--check", "--folder", ""], 2, "a value is required for '--folder <FOLDER>'"),
    ];
    for (arguments, code, words) in cases {
        let outcome = fixture.run(&[&["exercise"], arguments].concat());
        assert_eq!((outcome.code, &*outcome.out), (code, ""), "{arguments:?}: {}", outcome.err);
        assert!(
            outcome.err.starts_with("error: ") && outcome.err.contains(words),
            "{}",
            outcome.err
        );
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    assert!(Path::new(&other).join("notes.txt").is_file());
}

#[test]
fn a_program_that_is_not_built_is_named_and_nothing_is_made() {
    let fixture = Fixture::new();
    let apart = tempfile::tempdir().expect("a temporary folder");
    let lonely = apart.path().join("alone").with_extension(std::env::consts::EXE_EXTENSION);
    fs::copy(fixture.tool(), &lonely).expect("a copy of the tool");
    let mut command = Command::new(lonely);
    let outcome =
        run(command.args(["exercise", "02.1", "--headless", "--root"]).arg(fixture.path("")));
    let line = "error: the program '02_basic' is not built; run: cargo build --bins\n";
    assert_eq!((outcome.code, &*outcome.err), (1, line));
    assert!(!fixture.path("target/exercises/02.1").exists());
}
