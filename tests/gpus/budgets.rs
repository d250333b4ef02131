//! Every chapter's default pipeline under a GPU's own compiler, held to what is recorded of it.
//!
//! `budgets.json` says what Mesa's RADV made of each chapter when it was last changed on purpose, and which
//! Mesa that was. A figure may not get worse unless the same commit writes it anew, with
//! `UPDATE=1 cargo test --test gpus`. Another Mesa gives other figures: then the test reports, and does not
//! fail.

use std::collections::BTreeMap;
use std::fs;

use serde_json::{Value, json};

/// What is recorded of a chapter for a family. In all but the waves, more is worse.
const FIGURES: [&str; 6] =
    ["programs", "instructions", "registers", "spilled_registers", "scratch_bytes", "waves"];
/// Instructions may grow by so much before it counts: a constant more is no decision.
const SLACK: f64 = 1.02;

/// A chapter's figures for each family, and the compiler that gave them.
fn compiled(chapter: &str) -> (Value, String) {
    let output = run::command(chapter)
        .args(["--size", "16x10", "--compile-for", "all", "--report", "-"])
        .output()
        .expect("the sample starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{chapter}: {errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    let rows = report["compiled_for"].as_array().expect("rows").clone();
    let compiler = rows[0]["compiler"].as_str().expect("a compiler").to_owned();
    let mut families = BTreeMap::new();
    for family in ["navi21", "navi31", "gfx1201"] {
        let rows: Vec<&Value> = rows.iter().filter(|row| row["family"] == family).collect();
        let figure =
            |name: &'static str| rows.iter().map(move |row| row[name].as_u64().unwrap_or_default());
        assert!(!rows.is_empty(), "{chapter}: nothing was made for {family}");
        assert!(figure("instructions").all(|count| count > 0), "{chapter}: an empty program");
        families.insert(
            family,
            json!({
                "programs": rows.len(),
                "instructions": figure("instructions").sum::<u64>(),
                "registers": figure("registers").max(),
                "spilled_registers": figure("spilled_registers").sum::<u64>(),
                "scratch_bytes": figure("scratch_bytes").max(),
                "waves": figure("waves").min(),
            }),
        );
    }
    (json!(families), compiler)
}

/// What is worse than recorded, a line a figure.
fn worse(chapter: &str, now: &Value, recorded: &Value) -> Vec<String> {
    let Some(families) = now.as_object() else { return Vec::new() };
    let mut lines = Vec::new();
    for (family, figures) in families {
        for name in FIGURES {
            let is = figures[name].as_f64().expect("a number");
            let Some(was) = recorded[family][name].as_f64() else {
                lines.push(format!("{chapter} {family}: no {name} is recorded"));
                continue;
            };
            let bad = match name {
                "waves" => is < was,
                "instructions" => is > was * SLACK,
                _ => is > was,
            };
            if bad {
                lines.push(format!("{chapter} {family}: {name} {was} before, {is} now"));
            }
        }
    }
    lines
}

#[test]
fn no_chapter_costs_a_gpu_more_than_is_recorded() {
    let file = run::root().join("tests/gpus/budgets.json");
    let mut now = BTreeMap::new();
    let mut compiler = String::new();
    for chapter in run::chapters_on_the_framework() {
        let (figures, by) = compiled(&chapter);
        now.insert(chapter, figures);
        compiler = by;
    }
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        let text = serde_json::to_string_pretty(&json!({ "compiler": compiler, "chapters": now }));
        fs::write(&file, text.expect("JSON") + "\n").expect("the table can be written");
        return;
    }
    let text = fs::read_to_string(&file).unwrap_or_else(|error| {
        panic!("no {}: {error}; UPDATE=1 cargo test --test gpus writes it", file.display())
    });
    let recorded: Value = serde_json::from_str(&text).expect("the table is JSON");
    let lines: Vec<String> = now
        .iter()
        .flat_map(|(chapter, figures)| worse(chapter, figures, &recorded["chapters"][chapter]))
        .collect();
    if recorded["compiler"] != compiler.as_str() {
        println!(
            "recorded with {}, compared with {compiler}:\n{}",
            recorded["compiler"],
            lines.join("\n")
        );
        return;
    }
    assert!(
        lines.is_empty(),
        "{}\nIf that is meant: UPDATE=1 cargo test --test gpus, in the same commit",
        lines.join("\n")
    );
}

#[test]
fn a_figure_that_got_worse_is_named() {
    let recorded = json!({ "navi31": {
        "programs": 1, "instructions": 1000, "registers": 64, "spilled_registers": 0,
        "scratch_bytes": 0, "waves": 16 } });
    let with = |name: &str, value: u64| {
        let mut now = recorded.clone();
        now["navi31"][name] = value.into();
        worse("06", &now, &recorded)
    };
    assert_eq!(with("instructions", 1010), [""; 0]);
    assert_eq!(with("waves", 20), [""; 0]);
    assert_eq!(with("registers", 48), [""; 0]);
    assert_eq!(with("instructions", 1021), ["06 navi31: instructions 1000 before, 1021 now"]);
    assert_eq!(with("spilled_registers", 1), ["06 navi31: spilled_registers 0 before, 1 now"]);
    assert_eq!(with("waves", 12), ["06 navi31: waves 16 before, 12 now"]);
    assert_eq!(worse("13", &recorded, &Value::Null).len(), FIGURES.len());
}
