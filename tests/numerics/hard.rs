//! The hard cases: every top rung is right on all of them, and the simplest rungs fail.

use std::sync::LazyLock;

use run::expected;
use serde_json::{Value, json};

use crate::cases;
use crate::tables::{Table, ladders, text};

const FILE: &str = "tests/data/hard_cases.json";
/// The report of chapter 24 for all hard cases.
static REPORT: LazyLock<Value> = LazyLock::new(|| cases(FILE));

#[test]
fn every_top_rung_is_right_on_every_hard_case() {
    let report = &*REPORT;
    hold(report);
    assert_eq!((&report["cases"], &report["skipped"]), (&306.into(), &0.into()));
    let rungs = report["rungs"].as_array().unwrap();
    // 65 rungs: the device's triangles cannot be called directly, and the sums cannot be traced.
    assert_eq!(rungs.len(), 2 * 65 - 1 - 4);
    let mut tops = 0;
    for row in rungs {
        let number = |key: &str| row[key].as_u64().unwrap();
        if row.get("unavailable").is_some() {
            continue;
        }
        let verdicts = ["right", "inexact", "false_hits", "false_misses", "never_offered"];
        let told: u64 = verdicts.iter().map(|key| number(key)).sum();
        assert_eq!(told + number("not_finite"), number("run"), "{row}");
        // No rung, however simple, returns infinity or NaN.
        assert_eq!(number("not_finite"), 0, "{row}");
        if row["top"] == true {
            assert_eq!(number("right"), number("cases"), "{row}");
            tops += 1;
        }
    }
    // The simplest rungs must fail; otherwise the cases are not hard.
    let wrong = |rung: &str| -> u64 {
        let rows = rungs.iter().filter(|row| row["rung"] == rung && row["way"] == "direct");
        rows.map(|row| row["run"].as_u64().unwrap() - row["right"].as_u64().unwrap()).sum()
    };
    for rung in ["S0", "B0", "P0", "C0", "I0", "H0", "O0", "A0", "K0", "Q0", "L0", "V1", "F0"] {
        assert!(wrong(rung) > 0, "{rung} fails nothing");
    }
    // Direct and traced: S4, S5, B3, B4, P3, P4, T3, C2, C3, I2, H3, O5, K2, K3, Q2, L2, L3, V3, V4, F3 and F4; A3 only
    // directly. Every device has at least H3 and A3.
    let all_are_there = rungs.iter().all(|row| row.get("unavailable").is_none());
    let least = if all_are_there { 2 * 21 + 1 } else { 3 };
    assert!(tops >= least, "only {tops} top rungs, direct and traced");
}

/// Compares with the pages' values for the cases.
fn hold(report: &Value) {
    expected::hold_exact("README/hard_cases", json!({ "cases": report["cases"] }));
    let (mut table, mut rungs) = (Table::new(), 0);
    for (shape, rows) in ladders(report) {
        table.insert(format!("{shape}.cases"), rows[0]["cases"].clone());
        for row in rows.iter().filter(|row| is_own(row)) {
            table.insert(text(row, "rung").to_owned(), row["right"].clone());
            rungs += 1;
        }
    }
    expected::hold("24_accuracy/hard_cases", table.into());
    let cases = &report["cases"];
    expected::hold_exact("24_accuracy/ladders", json!({ "rungs": rungs, "cases": cases }));
    expected::hold("24_accuracy/traced", traced(report).into());
}

/// Returns whether a row is for its rung called directly, or for the device's own triangles, which can only
/// be traced.
pub fn is_own(row: &Value) -> bool {
    row["way"] == if row["rung"] == "T0" { "traced" } else { "direct" }
}

/// The number of answers direct and traced, of those that differ, and of cases never passed to the
/// intersection shader.
fn traced(report: &Value) -> Table {
    let answers = report["answers"].as_array().expect("answers");
    let of = |way: &'static str| answers.iter().filter(move |answer| answer["way"] == way);
    let (mut both, mut differ) = (0, 0);
    for answer in of("direct") {
        let is_same = |key: &str, other: &Value| answer[key] == other[key];
        let other = of("traced").find(|other| is_same("case", other) && is_same("rung", other));
        let Some(other) = other else { continue };
        both += 1;
        // A traced answer has no number of hits, which may be what is wrong with a direct one.
        differ += u32::from(!is_same("hit", other) || !is_same("t", other));
    }
    let never = of("traced").filter(|answer| answer["verdict"] == "never-offered").count();
    let counts = [("both", both), ("differ", differ), ("never_offered", never as u32)];
    counts.into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect()
}

/// The case the page computes by hand: an eye 1 above a sphere of radius a million.
#[test]
fn one_subtraction_decides_a_case_that_is_followed_by_hand() {
    let text = std::fs::read_to_string(run::root().join(FILE)).expect("the cases");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let case = all["cases"].as_array().unwrap().iter().find(|case| case["id"] == CASE).unwrap();
    let number = |of: &Value| of.as_f64().unwrap();
    let (shape, ray) = (&case["shape"], &case["ray"]);
    let distance = number(&ray["origin"][1]) - number(&shape["center"][1]);
    let radius = number(&shape["radius"]);
    let exact = distance * distance - radius * radius;
    let rounded = (distance * distance) as f32 - (radius * radius) as f32;
    let large = (radius * radius) as f32;
    let step = large.next_up() - large;
    let off = f64::from(rounded) / exact - 1.0;
    let found = json!({ "exact": exact, "step": step, "rounded": rounded, "off": off });
    expected::hold_exact("24_accuracy/by_hand", found);

    let report = &*REPORT;
    let answers = report["answers"].as_array().unwrap();
    let answer = |rung: &str| {
        let is_it = |answer: &&Value| {
            answer["case"] == CASE && answer["rung"] == rung && answer["way"] == "direct"
        };
        answers.iter().find(is_it).unwrap()
    };
    let t: f64 = case["expect"]["t"].as_str().unwrap().parse().unwrap();
    let mut table = Table::from_iter([("exact".to_owned(), t.into())]);
    for rung in ["S0", "S2", "S0h", "S4"] {
        table.insert(rung.to_owned(), answer(rung)["t"].clone());
        table.insert(format!("{rung}.ulp"), answer(rung)["ulp"].clone());
    }
    expected::hold("24_accuracy/planet", table.into());
    let ulp = |rung: &str| number(&answer(rung)["ulp"]);
    assert!(ulp("S0") > 1e5 && ulp("S2") > 1e5, "the page says that the shader's c is noise");
    assert!(ulp("S0h") <= 1.0 && ulp("S4") <= 1.0, "and that two rungs are right all the same");
}

const CASE: &str = "planet_6deg";

/// The sphere's cases with all lengths multiplied by a number, and so t, too. A direction of another length has cases of
/// its own.
fn resized(by: f64) -> Value {
    let text = std::fs::read_to_string(run::root().join(FILE)).expect("the cases");
    let mut all: Value = serde_json::from_str(&text).expect("JSON");
    let list = all["cases"].as_array_mut().expect("cases");
    let family = |case: &Value| case["family"].as_str().unwrap_or_default().to_owned();
    list.retain(|case| case["primitive"] == "sphere" && !family(case).starts_with("dir-scale"));
    let scaled = |number: &Value| Value::from(by * number.as_f64().expect("a number"));
    for case in list {
        for (of, key) in [("ray", "tmin"), ("shape", "radius")] {
            case[of][key] = scaled(&case[of][key]);
        }
        for (of, key) in [("ray", "origin"), ("shape", "center")] {
            case[of][key].as_array_mut().expect("a vector").iter_mut().for_each(|x| *x = scaled(x));
        }
        if let Some(t) = case["expect"]["t"].as_str() {
            let t: f64 = t.parse().expect("a decimal");
            case["expect"]["t"] = format!("{:e}", by * t).into();
        }
    }
    all
}

/// Where squares underflow or overflow, a sphere in 32 bits is missed
/// (<https://github.com/aardvark-platform/aardvark.base/issues/127>); in two floats it is scaled first.
#[test]
fn spheres_of_1e_30_and_of_1e19_are_right_in_two_floats() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut table = Table::new();
    for (name, exponent) in [("small", -100), ("large", 64)] {
        let file = folder.path().join("resized.json");
        std::fs::write(&file, resized(2f64.powi(exponent)).to_string()).expect("it is written");
        let file = file.to_str().expect("a plain name");
        let output = crate::laboratory(&["--cases", file, "--report", "-"]);
        let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
        let rows = report["rungs"].as_array().expect("rungs").iter();
        for row in rows.filter(|row| is_own(row) && row.get("unavailable").is_none()) {
            println!("{name} {}: {} of {}", row["rung"], row["right"], row["cases"]);
            table.insert(format!("{name}.{}", text(row, "rung")), row["right"].clone());
            table.insert("cases".to_owned(), row["cases"].clone());
        }
        assert_eq!(table[&format!("{name}.S4")], table["cases"], "{name}");
        assert!(table[&format!("{name}.S2")].as_u64() < Some(10), "{name} is not hard");
    }
    expected::hold("24_accuracy/sizes", table.into());
}
