//! Compiles every chapter's default pipeline with a GPU's own compiler, and compares the figures with the
//! recorded ones.
//!
//! `budgets.json` records the figures of Mesa's RADV and ANV for each chapter when it was last changed on purpose,
//! for each version of Mesa that was used. A figure may not get worse unless the same commit records it
//! again, with `UPDATE=1 cargo test --test gpus`. Figures are compared with those of the same Mesa; for one
//! without records the test only prints them. Mesa caches its results by shader and version, so only changes
//! are compiled again.

use std::collections::BTreeMap;
use std::fs;

use instruments::compile_for::{INTEL, RADEON};
use serde_json::{Map, Value, json};

/// The recorded figures of a chapter for a family of Radeons. For all except the waves, more is worse.
const OF_RADEON: [&str; 6] =
    ["programs", "instructions", "registers", "spilled_registers", "scratch_bytes", "waves"];
/// The recorded figures for a family of Intel GPUs.
const OF_INTEL: [&str; 4] = ["programs", "instructions", "live_registers", "spills"];
/// The factor by which instructions may grow: one more constant is not a decision.
const SLACK: f64 = 1.02;

/// The recorded figures for a family.
fn figures_of(family: &str) -> &'static [&'static str] {
    if INTEL.contains(&family) { &OF_INTEL } else { &OF_RADEON }
}

/// A chapter's figures for one family or for `all`, and the Mesa that produced them; `None` if the compiler
/// is not installed.
fn compiled(chapter: &str, asked: &str) -> Option<(Value, String)> {
    let rows = run::compiled_for(chapter, asked, &["--size", "16x10"])?;
    let compiler = rows[0]["compiler"].as_str().expect("a compiler");
    // For "radv Mesa 25.0.7-2~bpo12+1", for example: the packager does not affect the figures.
    let mesa = compiler.rsplit_once("Mesa ").map_or(compiler, |(_, version)| version);
    let mesa = mesa.split(['-', ' ']).next().unwrap_or(mesa).to_owned();
    let mut families = BTreeMap::new();
    for family in RADEON.into_iter().chain(INTEL) {
        let rows: Vec<&Value> = rows.iter().filter(|row| row["family"] == family).collect();
        if rows.is_empty() {
            // Intel's cards have to be built first.
            let may_lack = asked != "all" || INTEL.contains(&family);
            assert!(may_lack, "{chapter}: nothing was made for {family}");
            continue;
        }
        let figure =
            |name: &'static str| rows.iter().map(move |row| row[name].as_u64().unwrap_or_default());
        assert!(figure("instructions").all(|count| count > 0), "{chapter}: an empty program");
        let recorded = figures_of(family).iter().map(|&name| {
            let value = match name {
                "programs" => Some(rows.len() as u64),
                "instructions" | "spilled_registers" | "spills" => Some(figure(name).sum()),
                "waves" => figure(name).min(),
                _ => figure(name).max(),
            };
            (name.to_owned(), json!(value))
        });
        families.insert(family, recorded.collect::<Map<String, Value>>());
    }
    assert!(!families.is_empty(), "{chapter}: nothing was made for {asked}");
    Some((json!(families), format!("Mesa {mesa}")))
}

/// The figures that are worse than recorded, one line each.
fn worse(chapter: &str, now: &Value, recorded: &Value) -> Vec<String> {
    let Some(families) = now.as_object() else { return Vec::new() };
    let mut lines = Vec::new();
    for (family, figures) in families {
        for &name in figures_of(family) {
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

/// The figures that are worse than recorded for this Mesa, and those without any record.
fn faults(recorded: &Value, mesa: &str, now: &BTreeMap<String, Value>) -> Vec<String> {
    let known = |chapter: &str| {
        let mut all = recorded.as_object().into_iter().flat_map(Map::values);
        all.any(|chapters| chapters.get(chapter).is_some())
    };
    let mut lines = Vec::new();
    for (chapter, figures) in now {
        match &recorded[mesa][chapter] {
            Value::Null if known(chapter) => println!("{chapter}: {mesa} makes {figures} of it"),
            was => lines.extend(worse(chapter, figures, was)),
        }
    }
    lines
}

/// Records this Mesa's figures. For a chapter that has changed, the records of other versions, and of families that
/// were not compiled, are removed.
fn record(recorded: &Value, mesa: &str, mut now: BTreeMap<String, Value>) -> Value {
    let mut all = recorded.as_object().cloned().unwrap_or_default();
    if let Some(before) = all.remove(mesa) {
        let same = |chapter: &str| match (before.get(chapter), now.get(chapter)) {
            (Some(Value::Object(was)), Some(is)) => {
                was.iter().all(|(family, figures)| is.get(family).is_none_or(|is| is == figures))
            }
            (was, _) => was.is_none(),
        };
        for chapters in all.values_mut().filter_map(Value::as_object_mut) {
            chapters.retain(|chapter, _| now.contains_key(chapter) && same(chapter));
        }
        let unchanged: Vec<String> = now.keys().filter(|chapter| same(chapter)).cloned().collect();
        for chapter in unchanged {
            let was = before[&chapter].as_object().into_iter().flatten();
            for (family, figures) in was {
                if now[&chapter].get(family).is_none() {
                    now.get_mut(&chapter).expect("a chapter")[family] = figures.clone();
                }
            }
        }
    }
    all.insert(mesa.to_owned(), json!(now));
    all.into()
}

fn updates() -> bool {
    std::env::var_os("UPDATE").is_some_and(|value| value == "1")
}

#[test]
fn no_chapter_costs_a_gpu_more_than_is_recorded() {
    costs_no_more(if updates() { "all" } else { "navi31" });
}

#[test]
#[ignore = "nightly: every family; quick: budgets::no_chapter_costs_a_gpu_more_than_is_recorded"]
fn nor_does_one_cost_a_gpu_of_another_family_more() {
    costs_no_more("all");
}

fn costs_no_more(asked: &str) {
    let file = run::root().join("tests/gpus/budgets.json");
    let mut now = BTreeMap::new();
    let mut mesa = String::new();
    for chapter in run::chapters_on_the_framework() {
        let Some((figures, by)) = compiled(&chapter, asked) else { return };
        now.insert(chapter, figures);
        mesa = by;
    }
    let text = fs::read_to_string(&file).unwrap_or_else(|error| {
        panic!("no {}: {error}; UPDATE=1 cargo test --test gpus writes it", file.display())
    });
    let recorded: Value = serde_json::from_str(&text).expect("the table is JSON");
    if updates() {
        let text = serde_json::to_string_pretty(&record(&recorded, &mesa, now)).expect("JSON");
        fs::write(&file, text + "\n").expect("the table can be written");
        return;
    }
    let lines = faults(&recorded, &mesa, &now);
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
    assert_eq!(worse("13", &recorded, &Value::Null).len(), OF_RADEON.len());
    let recorded = json!({ "bmg": {
        "programs": 4, "instructions": 1000, "live_registers": 206, "spills": 0 } });
    let mut now = recorded.clone();
    now["bmg"]["live_registers"] = 210.into();
    now["bmg"]["spills"] = 3.into();
    let lines = ["05 bmg: live_registers 206 before, 210 now", "05 bmg: spills 0 before, 3 now"];
    assert_eq!(worse("05", &now, &recorded), lines);
}

#[test]
fn a_reader_is_held_to_the_figures_of_his_own_mesa() {
    let figures = |instructions: u64| {
        json!({ "navi31": {
            "programs": 1, "instructions": instructions, "registers": 64, "spilled_registers": 0,
            "scratch_bytes": 0, "waves": 16 } })
    };
    let now = |basic, hits| {
        BTreeMap::from([("02".to_owned(), figures(basic)), ("03".to_owned(), figures(hits))])
    };
    let recorded = json!({ "Mesa 1": now(100, 200), "Mesa 2": { "02": figures(50) } });
    assert_eq!(faults(&recorded, "Mesa 1", &now(100, 200)), [""; 0]);
    assert_eq!(
        faults(&recorded, "Mesa 2", &now(100, 200)),
        ["02 navi31: instructions 50 before, 100 now"]
    );
    // This version has no records, and those of another do not apply to it.
    assert_eq!(faults(&recorded, "Mesa 3", &now(1000, 2000)), [""; 0]);
    let new = BTreeMap::from([("04".to_owned(), figures(1))]);
    assert_eq!(faults(&recorded, "Mesa 3", &new).len(), OF_RADEON.len());
    // Records of other versions are removed for chapters that have changed or are gone; a first record
    // removes nothing.
    let changed = record(&recorded, "Mesa 1", now(90, 200));
    assert_eq!(changed, json!({ "Mesa 1": now(90, 200), "Mesa 2": {} }));
    let first = record(&recorded, "Mesa 3", now(1, 2));
    assert_eq!((&first["Mesa 2"], &first["Mesa 3"]), (&recorded["Mesa 2"], &json!(now(1, 2))));
}

#[test]
fn a_family_that_was_not_asked_keeps_its_figures_until_the_chapter_changes() {
    let radeon = |instructions: u64| json!({ "navi31": { "instructions": instructions } });
    let both = |instructions: u64| {
        let mut figures = radeon(instructions);
        figures["dg2"] = json!({ "instructions": 7 });
        figures
    };
    let of = |figures: Value| BTreeMap::from([("02".to_owned(), figures)]);
    let recorded = json!({ "Mesa 1": of(both(100)), "Mesa 2": of(radeon(50)) });
    assert_eq!(record(&recorded, "Mesa 1", of(radeon(100))), recorded);
    let changed = record(&recorded, "Mesa 1", of(radeon(90)));
    assert_eq!(changed, json!({ "Mesa 1": of(radeon(90)), "Mesa 2": {} }));
    // Asked for the first time, it leaves the other Mesa's figures alone.
    let before = json!({ "Mesa 1": of(radeon(100)), "Mesa 2": of(radeon(50)) });
    assert_eq!(record(&before, "Mesa 1", of(both(100))), recorded);
}
