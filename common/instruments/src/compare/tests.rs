use std::sync::Mutex;

use clap::FromArgMatches;
use common::app::Args;
use common::gpu::Gpu;
use common::{Controls, Frame, Sample, Setup};

use super::*;

#[test]
fn ratios_are_of_the_same_round() {
    // A machine that slows down by half a percent per frame: medians of times would be skewed.
    let mut slow = 1.0;
    let comparison = compare("rung", &["a".into(), "b".into()], 30, |value| {
        slow *= 1.005;
        Ok(if value == "b" { 2.0 * slow } else { slow })
    });
    let comparison = comparison.unwrap();
    assert!((comparison.values[1].ratio.median - 2.0).abs() < 0.03, "{comparison:?}");
    assert!((comparison.noise.median - 1.0).abs() < 0.03, "{comparison:?}");
    assert!(comparison.table().contains("| b |"), "{}", comparison.table());
}

#[test]
fn every_value_goes_first_and_last() {
    let mut order = Vec::new();
    let values = ["a".to_owned(), "b".to_owned()];
    compare("rung", &values, 6, |value| {
        order.push(value.to_owned());
        Ok(1.0)
    })
    .unwrap();
    // Two warm-up frames for each.
    let rounds: Vec<_> = order[4..].chunks(3).map(|round| round[0].as_str()).collect();
    assert!(rounds.contains(&"a") && rounds.contains(&"b"), "{rounds:?}");
}

#[test]
fn a_comparison_needs_a_name_and_two_values() {
    assert_eq!(parse("mode=a| b c").unwrap(), ("mode".into(), vec!["a".into(), "b c".into()]));
    for wrong in ["mode", "mode=a", "=a|b"] {
        assert!(parse(wrong).unwrap_err().0.contains("NAME=A|B"), "{wrong}");
    }
}

/// A sample that records the builds and frames requested of it.
#[derive(Default)]
struct Noting {
    preset: u32,
    height: u32,
}

static NOTES: Mutex<Vec<String>> = Mutex::new(Vec::new());

impl Sample for Noting {
    fn new(_: &Gpu, _: &Setup) -> Result<Self> {
        Ok(Self::default())
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.integer("preset", &mut self.preset, 0..=9) {
            self.height = 10 * self.preset;
        }
        c.integer("height", &mut self.height, 0..=99);
    }

    fn changed(&mut self, _: &Gpu) -> Result<()> {
        NOTES.lock().unwrap().push(format!("build {}, {}", self.preset, self.height));
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        NOTES.lock().unwrap().push(format!("frame {}", frame.index));
        Ok(())
    }
}

#[test]
fn what_a_value_asks_for_is_built_before_its_frame() {
    let arguments = ["test", "--headless", "--size", "8x8", "--compare", "preset=1|2"];
    let found = crate::command().try_get_matches_from(arguments).unwrap();
    let args = Args::from_arg_matches(&found).unwrap();
    let options = crate::Options::from_arg_matches(&found).unwrap();
    crate::start::<Noting>("test", &args, options).unwrap();
    let mut notes = std::mem::take(&mut *NOTES.lock().unwrap());
    // `render` is called once per band.
    notes.dedup();
    for pair in notes.chunks(2) {
        assert!(pair[0].starts_with("build ") && pair[1] == "frame 0", "{pair:?}");
    }
    let built = |note: &&String| note.starts_with("build 2, 20");
    assert!(notes[0] == "build 1, 10" && notes.iter().any(|note| built(&note)), "{notes:?}");
}
