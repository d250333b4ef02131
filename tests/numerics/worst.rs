//! The hard cases in the worst arithmetic that conforms.

use serde_json::Value;

use crate::laboratory;

/// The rungs that are right because 64-bit floats are: Vulkan promises no more of them than of 32 bits.
const NEED_64_BITS: [&str; 4] = ["S5", "B4", "P4", "C3"];

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

fn every_top_rung_is_right(arithmetic: &str) {
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

#[test]
fn every_top_rung_is_right_in_the_worst_arithmetic() {
    every_top_rung_is_right("worst");
}

#[test]
fn every_top_rung_is_right_where_copies_of_a_formula_disagree() {
    every_top_rung_is_right("worst-by-place");
}
