//! Files of cases: others work as well, and invalid ones are refused with one line.

use serde_json::{Value, json};

use crate::{cases, laboratory};

fn case(primitive: &str, shape: Value, expect: Value) -> Value {
    let ray = json!({"origin": [0, 0, 5], "dir": [0, 0, -1], "tmin": 0, "tmax": 100});
    json!({
        "id": format!("my {primitive}"), "primitive": primitive, "family": "mine", "ray": ray,
        "shape": shape, "expect": expect, "tol": {"t_ulp": 1}
    })
}

fn sphere() -> Value {
    let expect = json!({"hit": "yes", "t": "4.0", "normal": ["0", "0", "1"]});
    case("sphere", json!({"center": [0, 0, 0], "radius": 1}), expect)
}

fn file(cases: &[Value]) -> Value {
    json!({"schema": "rt-hard-cases/2", "cases": cases})
}

/// Writes a file of cases and calls `f` with its path.
fn with_file<T>(text: &str, f: impl FnOnce(&str) -> T) -> T {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("mine.json");
    std::fs::write(&path, text).expect("it can be written");
    f(path.to_str().expect("a plain name"))
}

fn refused(text: &str) -> String {
    let (code, line) =
        with_file(text, |path| run::refusal(laboratory(&["--cases", path, "--report", "-"])));
    assert_eq!(code, 1, "{line}");
    line
}

#[test]
fn another_file_of_the_schema_works() {
    let box_expect = json!({"hit": "yes", "t": "4.0", "faces": ["+z"]});
    let other = file(&[
        sphere(),
        case("box", json!({"lo": [-1, -1, -1], "hi": [1, 1, 1]}), box_expect),
        case("plane", json!({"normal": [0, 0, 2], "d": 1}), json!({"hit": "yes", "t": "4"})),
    ]);
    let report = with_file(&other.to_string(), cases);
    assert_eq!((&report["cases"], &report["skipped"]), (&3.into(), &0.into()));
    let answers = report["answers"].as_array().unwrap();
    assert!(answers.iter().all(|answer| answer["verdict"] == "right"), "{answers:?}");
    // Seven rungs for the sphere, five for the box, six for the plane, each direct and traced.
    assert_eq!(answers.len(), 2 * (7 + 5 + 6));
}

#[test]
fn a_wrong_answer_fails_and_is_named() {
    let mut wrong = sphere();
    wrong["expect"]["t"] = "4.00001".into();
    let (code, line) = with_file(&file(&[wrong]).to_string(), |path| {
        let folder = tempfile::tempdir().unwrap();
        let report = folder.path().join("report.json");
        let output = laboratory(&["--cases", path, "--report", report.to_str().unwrap()]);
        assert!(report.is_file(), "what was found is written all the same");
        run::refusal(output)
    });
    assert_eq!(code, 1);
    assert!(line.contains("my sphere S4 direct: Inexact t in ULP is off by"), "{line}");
}

fn edit(case: &Value, key: &str, value: Value) -> Value {
    let mut edited = case.clone();
    edited[key] = value;
    edited
}

#[test]
fn a_mean_of_zero_is_right() {
    let shape = json!({"pattern": "constant", "value": 0, "n": 3});
    let expect = json!({"mean": "0"});
    let zero = json!({"id": "dark", "primitive": "accumulation", "family": "mine", "shape": shape,
        "expect": expect, "tol": {"mean_rel": 1e-6}});
    let report = with_file(&file(&[zero]).to_string(), cases);
    let answers = report["answers"].as_array().unwrap();
    assert!(answers.iter().all(|answer| answer["verdict"] == "right"), "{answers:?}");
}

fn sum(n: u32, shape: Value, mean: &str) -> Value {
    let mut shape = shape;
    shape["n"] = n.into();
    json!({"id": format!("{n} samples"), "primitive": "accumulation", "family": "mine",
        "shape": shape, "expect": {"mean": mean}, "tol": {"mean_rel": 1.2e-7}})
}

/// Of 2^24 + 5 samples the last one is bright, and the third as well; a float counter would miss the last. A
/// sum of floats stops growing at 2^24.
#[test]
fn sums_may_be_longer_than_a_float_can_count() {
    let lights = json!({"pattern": "firefly", "value": 0, "spike": 1, "every": 5_592_407});
    let ones = json!({"pattern": "constant", "value": 1});
    let both = file(&[
        sum((1 << 24) + 5, lights, "1.78813881158276242e-7"),
        sum(1 << 26, ones.clone(), "1"),
    ]);
    let report = with_file(&both.to_string(), cases);
    let answers = report["answers"].as_array().unwrap();
    let found = |case: &str, rung: &str| {
        let one = |answer: &&Value| answer["case"] == case && answer["rung"] == rung;
        let answer = answers.iter().find(one).unwrap();
        (answer["verdict"].as_str().unwrap().to_owned(), answer["t"].as_f64().unwrap())
    };
    assert_eq!(found("67108864 samples", "A0"), ("inexact".to_owned(), 0.25));
    assert_eq!(found("67108864 samples", "A3"), ("right".to_owned(), 1.0));
    assert_eq!(found("16777221 samples", "A0").0, "right");
    assert_eq!(found("16777221 samples", "A3").0, "right");

    let longer = file(&[sum((1 << 26) + 1, ones, "1")]);
    let line = refused(&longer.to_string());
    assert!(line.contains("n is 67108865, not 1 to 67108864"), "{line}");
    let many = |number| {
        let ones = json!({"pattern": "constant", "value": 1});
        edit(&sum(1 << 26, ones, "1"), "id", format!("sum {number}").into())
    };
    let line = refused(&file(&(0..129).map(many).collect::<Vec<_>>()).to_string());
    let most = "the sums have 8657043456 samples together; 8589934592 are the limit";
    assert!(line.contains(most), "{line}");
}

#[test]
fn the_report_does_not_take_the_place_of_the_cases() {
    with_file(&file(&[sphere()]).to_string(), |path| {
        let before = std::fs::read(path).unwrap();
        let (code, line) = run::refusal(laboratory(&["--cases", path, "--report", path]));
        assert!(code == 2 && line.contains("--cases and --report both name"), "{line}");
        assert_eq!(std::fs::read(path).unwrap(), before);
    });
}

#[test]
fn a_folder_that_cannot_take_the_files_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("accuracy.png")).unwrap();
    let place = folder.path().to_str().unwrap();
    let arguments = ["--measure", place, "--only", "plane", "--rays", "1", "--rounds", "0"];
    let (code, line) = run::refusal(laboratory(&arguments));
    assert!(code == 1 && line.contains("accuracy.png': it is a folder"), "{line}");
    assert!(!folder.path().join("accuracy.json").exists());
}

#[test]
fn what_the_schema_does_not_know_is_refused() {
    let edited = |edit: &dyn Fn(&mut Value)| {
        let mut value = file(&[sphere()]);
        edit(&mut value);
        refused(&serde_json::to_string_pretty(&value).unwrap())
    };
    let sum = json!({"id": "sum", "primitive": "accumulation", "family": "mine", "shape": {
        "pattern": "zigzag", "value": 1, "n": 3}, "expect": {"mean": "1"}, "tol": {}});
    let dark = edit(&sum, "shape", json!({"pattern": "constant", "value": -1, "n": 3}));
    let never = json!({"pattern": "firefly", "value": 1, "n": 3, "spike": 2, "every": 0});
    let never = edit(&sum, "shape", never);
    let leaving = json!({
        "kind": "self", "center": [0, 0, 0], "radius": 1, "secondary_dir": [0, 0, 1]});
    let nowhere = case("secondary_origin", leaving, json!({"secondary_hit": "no"}));
    let nowhere = edit(&nowhere, "tol", json!({"offset_max": 1}));
    let checks: [(&str, String); 20] = [
        ("the schema is 'rt-hard-cases/3'", edited(&|v| v["schema"] = "rt-hard-cases/3".into())),
        ("there are no cases", edited(&|v| v["cases"] = json!([]))),
        ("2049 cases are too many", edited(&|v| v["cases"] = vec![sphere(); 2049].into())),
        ("unknown primitive 'torus'", edited(&|v| v["cases"][0]["primitive"] = "torus".into())),
        ("unknown field `colour`", edited(&|v| v["cases"][0]["shape"]["colour"] = 1.into())),
        ("unknown field `t_percent`", edited(&|v| v["cases"][0]["tol"]["t_percent"] = 1.into())),
        ("unknown variant `maybe`", edited(&|v| v["cases"][0]["expect"]["hit"] = "maybe".into())),
        ("'four' is no decimal", edited(&|v| v["cases"][0]["expect"]["t"] = "four".into())),
        ("a t is expected", edited(&|v| v["cases"][0]["expect"]["hit"] = "no".into())),
        ("1e300 is no finite f32", edited(&|v| v["cases"][0]["ray"]["tmax"] = 1e300.into())),
        ("direction is zero", edited(&|v| v["cases"][0]["ray"]["dir"] = json!([0, 0, 0]))),
        ("0 <= tmin <= tmax", edited(&|v| v["cases"][0]["ray"]["tmin"] = (-1).into())),
        (
            "the radius -1 is not above 0",
            edited(&|v| v["cases"][0]["shape"]["radius"] = (-1).into()),
        ),
        (" is not above 0", edited(&|v| v["cases"][0]["shape"]["radius"] = 1e-60.into())),
        ("a tolerance is -1", edited(&|v| v["cases"][0]["tol"]["t_ulp"] = (-1).into())),
        ("the sample -1 is below 0", edited(&|v| v["cases"][0] = dark.clone())),
        ("every is 0, not 1 to", edited(&|v| v["cases"][0] = never.clone())),
        ("no t is expected of the point", edited(&|v| v["cases"][0] = nowhere.clone())),
        ("the id is taken", edited(&|v| v["cases"] = json!([sphere(), sphere()]))),
        ("unknown pattern 'zigzag'", edited(&|v| v["cases"][0] = sum.clone())),
    ];
    for (expected, line) in checks {
        assert!(line.contains(expected), "{line} should say {expected}");
    }
    let line = edited(&|v| v["cases"][0]["shape"]["radius"] = (-1).into());
    assert!(line.contains("mine.json:") && line.contains("case 'my sphere'"), "{line}");
    let line = refused("{\"schema\": \"rt-hard-cases/2\",\n\"cases\": [\n");
    assert!(line.contains("mine.json:3"), "{line}");
}

#[test]
fn odd_command_lines_are_refused() {
    let refused = |arguments: &[&str]| run::refusal(laboratory(arguments));
    let (code, line) = refused(&["--cases", "no such file.json"]);
    assert!(code == 1 && line.contains("cannot read 'no such file.json'"), "{line}");
    let (code, line) = refused(&["--cases", "a.json", "--measure", "b"]);
    assert!(code == 2 && line.contains("cannot be used with"), "{line}");
    let (code, line) = refused(&["--measure", "b", "--rays", "0"]);
    assert!(code == 2 && line.contains("--rays"), "{line}");
    let (code, line) = refused(&["--measure", "b", "--only", "torus"]);
    assert!(code == 2 && line.contains("there is sphere, box, plane"), "{line}");
    let (code, line) = refused(&["--cases", "a.json", "--set", "rung=stable"]);
    assert!(code == 2 && line.contains("take no controls"), "{line}");
    for alone in [["--only", "plane"], ["--rays", "5"], ["--rounds", "5"]] {
        let (code, line) = refused(&alone);
        assert!(code == 2 && line.contains("--measure"), "{line}");
    }
    let (code, line) = refused(&["--tops"]);
    assert!(code == 2 && line.contains("--cases") && line.contains("--measure"), "{line}");
    let (code, line) = refused(&["--measure", "b", "--report", "r.json"]);
    assert!(code == 2 && line.contains("takes no --report"), "{line}");
    let (code, line) = refused(&["--cases", "a.json", "--scene", "a.obj"]);
    assert!(code == 2 && line.contains("take no --scene"), "{line}");
    let (code, line) = refused(&["--cases", "a.json", "--out", "a.png"]);
    assert!(code == 2 && line.contains("make no picture"), "{line}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_takes_no_more_memory_than_its_size_allows() {
    let text = file(&[sphere()]).to_string();
    let memory = |text: &str| {
        let mut command = run::command("24_accuracy");
        let spent = with_file(text, |path| {
            run::spend(command.args(["--headless", "--cases", path, "--report", "-"]))
        });
        let line = String::from_utf8_lossy(&spent.output.stderr).into_owned();
        (spent.output.status.success(), line, spent.memory)
    };
    // The first run may compile shaders that later ones find in the driver's cache.
    memory(&text);
    let (_, _, least) = memory(&text);
    // Unused fields are not stored. The numbers are written as text here: as values they would make this
    // process larger than the one it measures.
    let many = format!("{{\"conventions\": [{}0], ", "0,".repeat(4_000_000));
    let (success, line, most) = memory(&text.replacen('{', &many, 1));
    let more = most.saturating_sub(least);
    assert!(success && more < 40 << 20, "{more} {line}");
    let (success, line, most) = memory(&" ".repeat((8 << 20) + 1));
    assert!(!success && line.contains("has 8388609 bytes; at most 8388608 are read"), "{line}");
    assert!(most < least + (4 << 20), "{least} {most}");
}
