//! The atlas: its values on any device, and its detection of planted errors.

mod page;

use std::path::Path;

use run::shaders_with;
use serde_json::{Map, Value, json};

use crate::laboratory;

/// Rays per case.
const RAYS: &str = "200";

/// Renders an atlas under validation, with the shaders of a folder if there is one.
fn atlas(shaders: Option<&Path>, arguments: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let place = folder.path().to_str().expect("a temporary folder has a plain name");
    let mut command = run::command(crate::NAME);
    command.args(["--headless", "--validate", "--atlas", place, "--rays", RAYS, "--exact", "100"]);
    if let Some(shaders) = shaders {
        command.env("SHADERS", shaders);
    }
    let output = command.args(arguments).output().expect("it starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {errors}");
    assert!(folder.path().join("atlas.md").is_file());
    let text = std::fs::read_to_string(folder.path().join("atlas.json")).expect("it is there");
    let atlas: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(atlas["validation_messages"], json!([]));
    atlas
}

fn row<'a>(atlas: &'a Value, name: &str) -> &'a Value {
    let mut rows = atlas["rows"].as_array().expect("rows").iter();
    rows.find(|row| row["row"] == name).unwrap_or_else(|| panic!("no row {name}"))
}

fn cases(row: &Value) -> &[Value] {
    row["cases"].as_array().expect("cases")
}

fn case<'a>(atlas: &'a Value, name: &str, case: &str) -> &'a Map<String, Value> {
    let found = cases(row(atlas, name)).iter().find(|found| found["case"] == case);
    found.unwrap_or_else(|| panic!("no case {case}"))["found"].as_object().expect("numbers")
}

/// A number of a case; NaN if it is missing.
fn number(found: &Map<String, Value>, name: &str) -> f64 {
    found.get(name).unwrap_or_else(|| panic!("no {name}: {found:?}")).as_f64().unwrap_or(f64::NAN)
}

/// These bounds are no stricter than Vulkan's promises, or than the chapters' assumptions.
#[test]
fn every_row_holds_what_any_device_must() {
    let atlas = atlas(None, &[]);
    for row in atlas["rows"].as_array().expect("rows") {
        assert_eq!(row["beyond"], 0, "{row}");
        assert_ne!(row["kept"], false, "a chapter relies on more than {row}");
        let is_asked = row["unavailable"].is_null();
        assert_eq!(cases(row).is_empty(), !is_asked, "{row}");
        for found in cases(row) {
            assert_eq!(found["rays"].to_string(), RAYS, "{found}");
            let numbers = found["found"].as_object().expect("numbers");
            assert!(numbers.values().all(|value| value.is_number() || value.is_null()), "{found}");
        }
    }
    let rays: f64 = RAYS.parse().expect("a number");
    for found in cases(row(&atlas, "triangles")) {
        let numbers = found["found"].as_object().expect("numbers");
        let sum = |of: &str| -> f64 {
            let counts = found["buckets"][of].as_array().expect("buckets").iter();
            counts.map(|count| count.as_f64().expect("a count")).sum()
        };
        let without = number(numbers, "missed") + number(numbers, "hit beside");
        let judged = sum("t");
        assert!(judged <= rays && judged + without >= 0.9 * rays, "{found}");
        assert_eq!((sum("weights"), sum("weights ULP")), (2.0 * judged, 2.0 * judged), "{found}");
        for of in ["t", "weights", "weights ULP"] {
            let [p50, p99, max] =
                ["p50", "p99", "max"].map(|part| number(numbers, &format!("{of} {part}")));
            assert!(0.0 <= p50 && p50 <= p99 && p99 <= max, "{found}");
        }
    }
    for found in ["seams", "instances"].into_iter().flat_map(|name| cases(row(&atlas, name))) {
        let numbers = found["found"].as_object().expect("numbers");
        let number = |name| number(numbers, name);
        assert_eq!(number("lost"), number("hit the far side") + number("hit nothing"), "{found}");
        assert!(number("doubled") + number("lost") <= rays, "{found}");
        assert_eq!(number("not aimed"), 0.0, "{found}");
    }
    for found in cases(row(&atlas, "boxes")) {
        let numbers = found["found"].as_object().expect("numbers");
        let number = |name| number(numbers, name);
        assert!(number("lost") <= number("meet it") && number("meet it") <= rays, "{found}");
        assert!(
            number("meet it") + number("offered beside it") <= rays + number("lost"),
            "{found}"
        );
    }
    for found in cases(row(&atlas, "duplicates")) {
        let numbers = found["found"].as_object().expect("numbers");
        let number = |name| number(numbers, name);
        assert!(number("first wins") + number("second wins") <= rays, "{found}");
        assert!(number("called again") <= number("called"), "{found}");
    }
}

/// An intersection shader in two-floats stands in for a device. It is nearly exact; with one line changed it
/// is not, and the row about that line reports it.
#[test]
fn a_planted_error_is_seen() {
    let software = ["--traversal", "software"];
    let right = atlas(None, &software);
    if right["rows"].is_null() {
        return;
    }
    let t = |atlas: &Value, part: &str| {
        let found = cases(row(atlas, "triangles")).iter().map(|case| &case["found"][part]);
        let found: Vec<f64> = found.map(|value| value.as_f64().expect("an error")).collect();
        found.into_iter().fold([f64::INFINITY, 0.0f64], |[low, high], t| [low.min(t), high.max(t)])
    };
    let lost = |atlas: &Value, name: &str| number(case(atlas, "seams", name), "lost");
    let seams = ["edges exactly", "corners exactly", "edges rounded", "corners rounded"];
    assert!(t(&right, "t max")[1] <= 0.5, "{:?}", t(&right, "t max"));
    seams.iter().for_each(|name| assert_eq!(lost(&right, name), 0.0, "{name}"));

    let file = "common/triangle.glsl";
    let off = "t = uintBitsToFloat(floatBitsToUint(exact.x) + 2);";
    let off = atlas(Some(shaders_with(file, "t = exact.x;", off).path()), &software);
    // Below a power of two, a ULP is half as large as above it.
    let [[least, most], [_, largest]] = [t(&off, "t p50"), t(&off, "t max")];
    assert!(least >= 1.75 && most <= 2.25 && largest <= 4.5, "{least} {most} {largest}");
    seams.iter().for_each(|name| assert_eq!(lost(&off, name), 0.0, "{name}"));

    let kept = "if (!same_side(u, v, w)) {";
    let broken = "if (!same_side(u, v, w) || u * v * w == 0.0) {";
    let broken = atlas(Some(shaders_with(file, kept, broken).path()), &software);
    let rays: f64 = RAYS.parse().expect("a number");
    for name in &seams[..2] {
        assert_eq!(lost(&broken, name), rays, "an edge belongs to no triangle: {name}");
    }
    assert!(t(&broken, "t max")[1] <= 0.5);
}

/// The worst arithmetic calls the intersection shader more often than necessary, and the atlas counts the
/// calls.
#[test]
fn the_worst_arithmetic_is_seen() {
    if !run::has_worst_arithmetic() {
        return;
    }
    let worst = atlas(None, &["--arithmetic", "worst"]);
    let of = |flag| {
        let found = case(&worst, "duplicates", flag);
        ["called", "called again", "most calls"].map(|name| number(found, name))
    };
    let [called, again, most] = of("without the flag");
    assert!(again >= called && most >= 2.0, "{called} {again} {most}");
    // This driver calls it once; another may call it as often as it likes.
    if run::device::is_software() {
        assert!(again == called && most == 2.0, "{called} {again} {most}");
    }
    assert_eq!(of("with the flag")[1..], [0.0, 1.0]);
    let found = case(&worst, "boxes", "box from 10");
    assert_eq!(number(found, "offered beside it") + number(found, "meet it"), 200.0);
    assert!(number(case(&worst, "triangles", "distance 10"), "t p50") > 4.0);
}

#[test]
fn odd_atlases_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let place = folder.path().to_str().expect("a plain name");
    let refused = |arguments: &[&str]| run::refusal(laboratory(arguments));
    for (arguments, told) in [
        (&["--atlas", place, "--measure", place][..], "cannot be used with"),
        (&["--atlas", place, "--rays", "0"], "0 is not in 1..=1000000"),
        (&["--atlas", place, "--tops"], "cannot be used with"),
        (&["--atlas", place, "--report", "-"], "--atlas writes its report to the folder"),
        (&["--atlas", place, "--set", "show=error"], "take no controls"),
        (&["--atlas", place, "--traversal", "mine"], "[possible values: device, software]"),
        (&["--exact", "3"], "--atlas"),
        (&["--traversal", "software"], "--atlas"),
    ] {
        let (code, line) = refused(arguments);
        assert!(code == 2 && line.contains(told), "{arguments:?}: {line}");
    }
    std::fs::create_dir(folder.path().join("atlas.md")).expect("a folder");
    let (code, line) = refused(&["--atlas", place, "--rays", "1"]);
    assert!(code == 1 && line.contains("atlas.md': it is a folder"), "{line}");
    assert!(!folder.path().join("atlas.json").exists());
}
