//! Every chapter under Intel's whole driver, without the card: Mesa's ANV over the shim that `tests/intel/build` builds.

use run::cards::{Card, refusal};
use run::{chapters, chapters_on_the_framework, compiled_for, expected};
use serde_json::{Map, Value};

use crate::sweep::{TINY, runs, runs_all, shows_all};

/// A card of each generation with ray tracing: Arc A-series and B-series.
const CARDS: [Card; 2] = [Card("dg2"), Card("bmg")];

/// Settings that a card refuses, or that need what it never computes, and the line that says so.
const REFUSED: [(&str, &str, &[&str], &str); 3] = [
    ("15_opacity_micromaps", "way=device", &["dg2", "bmg"], "opacity_micromap"),
    ("24_accuracy", "rung=64 bits", &["dg2"], "shaderFloat64"),
    ("30_own_tree", "tree=device", &["dg2", "bmg"], "the device's tree of the mesh"),
];

#[test]
fn a_chapter_runs_on_intel_s_cards_that_are_not_there() {
    for card in CARDS {
        runs(card, "02_basic");
    }
}

/// Nothing is executed there, so a program with nothing but results to show says that.
#[test]
fn what_would_show_results_of_such_a_card_says_that_it_has_none() {
    let cases = run::root().join("tests/data/hard_cases.json");
    let cases = cases.to_str().expect("a plain path");
    for card in [Card("navi31"), Card("dg2")] {
        for (sample, arguments, words) in [
            (
                "02_basic",
                ["--pixel", "5,5"],
                "executes nothing, like every stand-in for a card: there are no rays",
            ),
            (
                "24_accuracy",
                ["--cases", cases],
                "executes nothing, like every stand-in for a card: there are no answers",
            ),
        ] {
            let Some(mut command) = card.command(sample) else { continue };
            command.arg("--headless").args(arguments);
            let (code, line) = refusal(&command.output().expect("it starts"));
            assert!(code == 1 && line.contains(words), "{sample} on {}: {line}", card.0);
        }
    }
}

#[test]
#[ignore = "nightly: every chapter and view; quick: intel::a_chapter_runs_on_intel_s_cards_that_are_not_there"]
fn every_chapter_and_each_of_its_views_runs_there() {
    for card in CARDS {
        runs_all(card);
        for sample in chapters() {
            let refused =
                REFUSED.iter().filter(|(name, _, on, _)| *name == sample && on.contains(&card.0));
            let refused: Vec<&str> = refused.map(|(_, setting, ..)| *setting).collect();
            shows_all(card, &sample, &refused);
        }
    }
}

#[test]
#[ignore = "nightly: six runs; quick: intel::a_chapter_runs_on_intel_s_cards_that_are_not_there"]
fn what_these_cards_cannot_show_is_refused_in_one_line() {
    for (sample, setting, cards, words) in REFUSED {
        for card in cards {
            let Some(mut command) = Card(card).command(sample) else { return };
            let output = command.args(TINY).args(["--set", setting]).output().expect("it starts");
            let (_, line) = refusal(&output);
            assert!(line.contains(words), "{sample} {setting} on {card}: {line}");
        }
    }
}

/// Figures of each chapter's shader with the most live registers on the B-series, for `docs/compilers.md`.
#[test]
#[ignore = "nightly: compiles every chapter; quick: intel::a_chapter_runs_on_intel_s_cards_that_are_not_there"]
fn the_fullest_shader_of_each_chapter_is_the_page_s() {
    let (mut values, mut compiler) = (Map::new(), String::new());
    for chapter in chapters_on_the_framework() {
        let rows = |family| compiled_for(&chapter, family, &["--size", "16x10"]);
        let (Some(first), Some(second)) = (rows("dg2"), rows("bmg")) else { return };
        let live = |row: &Value| row["live_registers"].as_u64();
        let Some(fullest) = second.iter().max_by_key(|row| live(row)) else { continue };
        // Fragment shaders have a program for each width, and cards differ in the widths.
        let same = |row: &&Value| row["stage"] == fullest["stage"];
        let other = first.iter().filter(same).max_by_key(|row| live(row)).expect("the same stage");
        let stage = fullest["stage"].as_str().expect("a name");
        let name = format!("{chapter},_{stage}").replace(['_', ' '], "-");
        for (family, row) in [("dg2", other), ("bmg", fullest)] {
            for figure in ["live_registers", "instructions", "sends", "spills", "fills"] {
                values.insert(format!("{name}.{family}.{figure}"), row[figure].clone());
            }
        }
        compiler = fullest["compiler"].as_str().expect("a compiler").to_owned();
    }
    let generations = "Arc A-series, Arc B-series";
    expected::hold_compiled_by("ANV", "compilers/intel", &compiler, generations, values.into());
}
