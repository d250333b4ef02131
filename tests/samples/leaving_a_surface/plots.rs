//! What the page of 26_leaving_a_surface shows beside its picture. Drawn when asked for:
//! `cargo test --test samples leaving_a_surface::plots -- --ignored --nocapture`.

use serde_json::{Map, json};

use super::{HIGH, NAME, RULES, SETTINGS, SIZE, Setting, Tally, picture};
use run::plot::{Shown, draw_panels};
use run::{copy_of_shaders, figures};

/// The places as a label has room for them, in the order of [`SETTINGS`].
const PLACES: [&str; 4] = ["0.001", "1", "1000", "moved"];

#[test]
#[ignore = "draws docs/images/26_origins.png"]
fn origins() {
    let show = |place: [&str; 2], rule: &str| {
        picture("640x400", &[&place[..], &[&format!("origin={rule}")]].concat())
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
#[ignore = "draws docs/images/26_leaks.png"]
fn leaks() {
    let show = |(setting, number): (usize, usize)| {
        let rule = RULES[number];
        let close = ["camera target=0.5,0.25,3.5", "field of view=7", &format!("origin={rule}")];
        let label = format!("O{number} {rule}, {}", PLACES[setting]);
        (label, picture("320x320", &[&SETTINGS[setting].0[..], &close].concat()))
    };
    let rows = [[(0, 1), (0, 2), (3, 4)], [(0, 5), (1, 5), (3, 5)]].map(|row| row.map(show));
    draw_panels("26_leaks.png", 1, &rows.each_ref().map(|row| Shown::row(row)));
}

#[test]
#[ignore = "prints what becomes of rays that start by each rule"]
fn table_of_origins() {
    let mut table = Map::new();
    for (setting, (place, _)) in SETTINGS.iter().enumerate() {
        let setting = Setting::new(setting, "240x150", HIGH);
        for rule in RULES.into_iter().chain(["height"]) {
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
            for (figure, percent) in [("acne", acne), ("lost", lost), ("dark", dark), ("lit", lit)]
            {
                table.insert(format!("{}.{rule}.{figure}", place.join(",")), percent.into());
            }
        }
    }
    figures::hold("26_leaving_a_surface/rules", table.into());
}

/// The self-hits where the bound's step is so many times as long.
#[test]
#[ignore = "prints what shorter steps let through"]
fn table_of_steps() {
    let mut table = Map::new();
    let mut rays = 0;
    for factor in ["1.0", "0.3", "0.1", "0.03", "0.01"] {
        let shaders = copy_of_shaders();
        let file = shaders.path().join(NAME).join("origin.glsl");
        let text = std::fs::read_to_string(&file).unwrap();
        let step = "from.position + step * from.normal, 0.0);";
        let scaled = step.replace("step *", &format!("{factor} * step *"));
        assert_eq!(text.matches(step).count(), 1);
        std::fs::write(&file, text.replace(step, &scaled)).unwrap();
        for (number, (place, _)) in SETTINGS.iter().enumerate() {
            let shaders = Some(shaders.path().to_owned());
            let setting = Setting { shaders, ..Setting::new(number, SIZE, HIGH) };
            let tally = setting.reflected("bound", 1);
            println!("{factor}, {}: {tally}", place.join(", "));
            table.insert(format!("{factor}.{}", place.join(",")), tally.self_hits.into());
            rays = rays.max(tally.rays);
        }
    }
    figures::hold("26_leaving_a_surface/steps", table.into());
    figures::hold("26_leaving_a_surface/rays", json!({ "rays": rays }));
}
