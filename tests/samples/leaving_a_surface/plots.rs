//! Plots for the page of 26_leaving_a_surface. Drawn on request: `cargo test --test samples
//! leaving_a_surface::plots -- --ignored --nocapture`.

use serde_json::Map;

use super::{HIGH, RULES, SETTINGS, Setting, Tally, chapter};
use run::expected;
use run::plot::{Shown, draw_panels};

/// The places, abbreviated for labels, in the order of [`SETTINGS`].
const PLACES: [&str; 4] = ["0.001", "1", "1000", "moved"];

#[test]
#[ignore = "by hand: draws docs/images/26_origins.png"]
fn origins() {
    let show = |place: [&str; 2], rule: &str| {
        chapter("640x400").sets(&place).set("origin", rule).picture()
    };
    let pictures = SETTINGS.map(|(place, _)| RULES.map(|rule| show(place, rule)));
    let row = |place: usize| {
        let shown = |number: usize| Shown {
            label: format!("O{number} {}, {}", RULES[number], PLACES[place]),
            picture: &pictures[place][number],
            area: [455, 130, 160, 160],
        };
        (0..RULES.len()).map(shown).collect()
    };
    draw_panels("26_origins.png", 1, &[0, 1, 2, 3].map(row));
}

#[test]
#[ignore = "by hand: draws docs/images/26_leaks.png"]
fn leaks() {
    let show = |(setting, number): (usize, usize)| {
        let rule = RULES[number];
        let close = ["camera target=0.5,0.25,3.5", "field of view=7", &format!("origin={rule}")];
        let label = format!("O{number} {rule}, {}", PLACES[setting]);
        (label, chapter("320x320").sets(&SETTINGS[setting].0[..]).sets(&close).picture())
    };
    let rows = [[(0, 1), (0, 2), (3, 4)], [(0, 5), (1, 5), (3, 5)]].map(|row| row.map(show));
    draw_panels("26_leaks.png", 1, &rows.each_ref().map(|row| Shown::row(row)));
}

#[test]
#[ignore = "by hand: prints what becomes of rays that start by each rule"]
fn table_of_origins() {
    let (mut table, mut offset) = (Map::new(), Map::new());
    for (number, (place, _)) in SETTINGS.iter().enumerate() {
        let setting = Setting::new(number, "240x150", HIGH);
        for rule in RULES.into_iter().chain(["offset", "magnitudes"]) {
            let tallies = [setting.reflected(rule, 1), setting.shadow(rule)];
            let percent = |count: fn(&Tally) -> usize| {
                tallies.each_ref().map(|tally| 100.0 * count(tally) as f64 / tally.rays as f64)
            };
            let [acne, dark] = percent(|tally| tally.self_hits);
            let [lost, lit] = percent(|tally| tally.lost);
            println!(
                "| {} | {rule} | {acne:.2} | {lost:.2} | {dark:.2} | {lit:.2} |",
                place.join(", ")
            );
            let row = [("acne", acne), ("lost", lost), ("dark", dark), ("lit", lit)];
            table.extend(row.map(|(key, part)| (format!("{number}.{rule}.{key}"), part.into())));
            if rule == "offset" {
                offset.insert(number.to_string(), (lost / 100.0).into());
            }
        }
    }
    expected::hold("26_leaving_a_surface/origins", table.into());
    expected::hold("26_leaving_a_surface/offset", offset.into());
}
