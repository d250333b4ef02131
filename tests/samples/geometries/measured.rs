//! The cost of one level with many geometries and of many levels with one each: memory, and build time.

use serde_json::{Map, Value};

use run::{Chapter, expected};

use super::{NAME, cut_in};

/// The report of a run with hardly any pixels.
fn report(levels: &str, cut: &str, parts: u32) -> Value {
    cut_in(Chapter::new(NAME).size("8x5").set("levels", levels), cut, parts).run().report
}

#[test]
fn bytes_of_one_level_and_of_many() {
    let mut held = Map::new();
    for parts in [1, 4, 16, 64] {
        let [one, many] = ["one", "many"].map(|levels| {
            let chapter = report(levels, "rings", parts)["chapter"].take();
            let names =
                ["levels", "instances", "built_bytes", "bytes", "scratch_bytes", "top_bytes"];
            let numbers = names.map(|name| chapter[name].as_u64().unwrap());
            for (name, number) in names.into_iter().zip(numbers) {
                held.insert(format!("{parts}.{levels}.{name}"), number.into());
            }
            numbers
        });
        println!("{parts}: {one:?}, {many:?}");
        // Compaction never enlarges.
        assert!(one[3] <= one[2] && many[3] <= many[2]);
    }
    expected::hold("44_geometries/bytes", held.into());
}

/// Builds alternate, so that the machine's other work affects both alike.
#[test]
#[ignore = "by hand: takes times"]
fn builds_in_time() {
    const ROUNDS: usize = 15;
    let mut table = Map::new();
    for parts in [1, 4, 16, 64] {
        let time = |levels: &str| {
            report(levels, "rings", parts)["acceleration_structure_milliseconds"].as_f64().unwrap()
        };
        let mut rounds: Vec<[f64; 2]> = (0..ROUNDS).map(|_| ["one", "many"].map(time)).collect();
        rounds.sort_by(|a, b| (a[1] / a[0]).total_cmp(&(b[1] / b[0])));
        let ratio = |at: usize| rounds[at][1] / rounds[at][0];
        let [low, middle, high] = [ROUNDS / 4, ROUNDS / 2, ROUNDS * 3 / 4].map(ratio);
        let mut one: Vec<f64> = rounds.iter().map(|round| round[0]).collect();
        one.sort_by(f64::total_cmp);
        println!(
            "{parts} parts: one {:.2} ms; many / one {middle:.2}, {low:.2} to {high:.2}",
            one[ROUNDS / 2]
        );
        for (name, value) in
            [("one", one[ROUNDS / 2]), ("ratio", middle), ("low", low), ("high", high)]
        {
            table.insert(format!("{parts}.{name}"), value.into());
        }
    }
    expected::give_timed("44_geometries/builds", table.into());
}
