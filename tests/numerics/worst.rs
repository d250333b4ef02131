//! The hard cases and the random families in the worst arithmetic that conforms: each top rung is held to
//! the bar that it has on the driver itself.

use serde_json::Value;

use crate::bars::{Row, report};
use crate::laboratory;

/// The rungs that are right because 64-bit floats are: Vulkan promises no more of them than of 32 bits.
const NEED_64_BITS: [&str; 4] = ["S5", "B4", "P4", "C3"];

/// What random rays are asked of, for its two-float rung or the like. A capsule's and an instance's takes
/// the driver's compiler more than ten seconds, and so have their hard cases only.
const MEASURED: [&str; 7] =
    ["sphere", "box", "plane", "triangle", "heightfield", "secondary origin", "accumulation"];

/// Rays of each family.
const RAYS: &str = "300";

fn cases(arithmetic: &str) -> Value {
    let file = "tests/data/hard_cases.json";
    let of = ["--cases", file, "--tops", "--report", "-", "--arithmetic", arithmetic];
    let output = laboratory(&of);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arithmetic}: {errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    assert_eq!(report["validation_messages"], serde_json::json!([]));
    assert_eq!(report["arithmetic"], arithmetic);
    report
}

fn every_hard_case_is_right(arithmetic: &str) {
    let report = cases(arithmetic);
    assert_eq!((&report["cases"], &report["skipped"]), (&114.into(), &0.into()));
    let mut tops = Vec::new();
    for row in report["rungs"].as_array().unwrap() {
        let (rung, number) =
            (row["rung"].as_str().unwrap(), |key: &str| row[key].as_u64().unwrap());
        assert!(row.get("unavailable").is_none(), "{row}");
        assert_eq!(number("not_finite"), 0, "{row}");
        println!("{arithmetic} {rung} {}: {} of {}", row["way"], number("right"), number("cases"));
        if row["top"] == true {
            assert_eq!(number("right"), number("cases"), "{row}");
            tops.push(rung);
        }
    }
    assert!(NEED_64_BITS.iter().all(|rung| !tops.contains(rung)));
    // S4, B3, P3, T3, C2, I2, H3 and O5 both ways, A3 one.
    assert_eq!(tops.len(), 2 * 8 + 1, "{tops:?}");
}

fn every_family_is_right(arithmetic: &str) {
    let only = MEASURED.into_iter().flat_map(|name| ["--only", name]);
    let arguments = ["--tops", "--rays", RAYS, "--arithmetic", arithmetic].into_iter().chain(only);
    let report = report(&arguments.collect::<Vec<_>>());
    assert_eq!(report["arithmetic"], arithmetic);
    let mut families = 0;
    for rung in report["rungs"].as_array().unwrap() {
        let label = rung["rung"].as_str().unwrap();
        for row in rung["errors"].as_array().unwrap().iter().map(|row| Row(row.clone())) {
            let place = format!("{arithmetic} {label} on {}, {}", row.0["family"], row.0["way"]);
            let (p99, most) = (row.number("p99"), row.number("max"));
            println!("{place}: p99 {p99:.3}, most {most:.3} ULP");
            assert_eq!(row.number("not_finite"), 0.0, "{place}");
            assert_eq!(row.number("false_misses") + row.number("never_offered"), 0.0, "{place}");
            // H3 marches in 32 bits: it may hit what a ray all but touches, and t has a bar at home.
            let is_home = row.0["family"] == "hills at 60°";
            assert!(label == "H3" && !is_home || row.number("false_hits") == 0.0, "{place}");
            match label {
                "H3" => assert!(!is_home || p99 <= 8.0, "{place}: {p99}"),
                // A departure is right or wrong, and has no other error.
                "O5" => {}
                _ => assert!(most <= 1.0, "{place}: {most}"),
            }
            families += 1;
        }
    }
    // Both ways 7 of spheres, 4 of boxes, 4 of planes, 5 of triangles and 5 of heightfields; one way 9 of
    // origins and 3 of sums.
    assert_eq!(families, 2 * 25 + 9 + 3);
}

#[test]
fn every_top_rung_is_right_in_the_worst_arithmetic() {
    every_hard_case_is_right("worst");
}

#[test]
fn every_top_rung_is_right_where_copies_of_a_formula_disagree() {
    every_hard_case_is_right("worst-by-place");
}

#[test]
fn every_top_rung_keeps_its_bar_on_random_rays() {
    every_family_is_right("worst");
}

#[test]
fn so_it_does_where_copies_of_a_formula_disagree() {
    every_family_is_right("worst-by-place");
}
