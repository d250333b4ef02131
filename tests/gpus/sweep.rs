//! Runs of chapters on a card that is not there: each chapter, and all that its controls show.

use run::cards::{Card, report, said};
use run::{chapters, command};

pub const TINY: [&str; 4] = ["--headless", "--validate", "--size", "16x10"];

/// Runs a chapter on a card to its end, without a message; false, and a line, where there is no such card.
pub fn runs(card: Card, sample: &str) -> bool {
    let Some(mut command) = card.command(sample) else { return false };
    // With figures the pipeline is cached for the test of budgets, which needs them.
    let output = command.args(TINY).args(["--report", "-", "--compiler-figures"]).output();
    let output = output.expect("it starts");
    let report = report(&format!("{sample} on {}", card.0), &output);
    let device = report["device"].as_str().expect("a name");
    assert!(card.is(device), "{sample}: {device}");
    true
}

/// Runs every chapter on a card.
pub fn runs_all(card: Card) {
    for sample in chapters() {
        if !runs(card, &sample) {
            return;
        }
    }
}

/// Shows each value of each choice and switch of a sample except these, one after the other in one process.
pub fn shows_all(card: Card, sample: &str, without: &[&str]) {
    let list = command(sample).arg("--list-controls").output().expect("it starts").stdout;
    for line in String::from_utf8(list).expect("text").lines() {
        let mut cells = line.split('\t');
        let [name, kind, values] =
            [(); 3].map(|()| cells.next().expect("a control has four cells"));
        if !["choice", "switch"].contains(&kind) {
            continue;
        }
        let Some(mut command) = card.command(sample) else { return };
        let is_shown = |value: &&str| !without.contains(&&*format!("{name}={value}"));
        let values: Vec<&str> = values.split(", ").filter(is_shown).collect();
        let all = format!("{name}={}", values.join("|"));
        let how = if values.len() > 1 { "--compare" } else { "--set" };
        let output = command.args(TINY).args([how, &all]).output().expect("it starts");
        assert!(output.status.success(), "{sample}, {all}: {}", said(&output));
        assert_eq!(said(&output), "", "{sample}, {all}: not silent");
    }
}
