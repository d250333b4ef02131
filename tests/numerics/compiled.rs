//! A GPU compiler's estimates for every rung.

use serde_json::Value;

use crate::tables;

const FAMILIES: [&str; 3] = ["navi21", "navi31", "gfx1201"];

/// Checks that each rung has estimates for each family, and that they agree with the page.
pub fn check(report: &Value) {
    if let Some(why) = report["no_compiler"].as_str() {
        assert!(run::NO_COMPILER.iter().any(|words| why.contains(words)), "{why}");
        return println!("not tried: {why}");
    }
    let rungs = report["rungs"].as_array().unwrap();
    for rung in rungs {
        let told = rung["compiled_for"].as_array().unwrap();
        // The device's own triangles need no program.
        if rung["rung"] == "T0" || rung.get("unavailable").is_some() {
            assert!(told.is_empty(), "{rung}");
            continue;
        }
        let families: Vec<_> = told.iter().map(|row| row["family"].as_str().unwrap()).collect();
        assert_eq!(families, FAMILIES, "{}", rung["rung"]);
        for row in told {
            for key in ["instructions", "registers", "waves", "latency", "inverse_throughput"] {
                assert!(row[key].as_u64().unwrap() > 0, "{}: {key}: {row}", rung["rung"]);
            }
            assert!(row["ratio"].as_f64().unwrap() >= 1.0, "{row}");
        }
    }
    let cost = |label: &str, family: &str| -> Option<f64> {
        let rung = rungs.iter().find(|rung| rung["rung"] == label).unwrap();
        let mut told = rung["compiled_for"].as_array().unwrap().iter();
        told.find(|row| row["family"] == family)?["inverse_throughput"].as_f64()
    };
    for (dear, cheap) in [("S4", "S0"), ("S5", "S0"), ("B4", "B2"), ("P4", "P2"), ("C3", "C1")] {
        for family in FAMILIES {
            let (Some(dear), Some(cheap)) = (cost(dear, family), cost(cheap, family)) else {
                continue;
            };
            assert!(dear > 4.0 * cheap, "{family}: {dear} is not far above {cheap}");
        }
    }
    // The page's value for the stable rungs, from Mesa 25; 26.2.6 puts two of them at 1.52.
    let most = if report["compiler"].as_str().unwrap().contains("Mesa 25.") { 1.5 } else { 1.53 };
    for stable in ["S2 stable", "P2 compensated", "I1 host inverse", "O5 bound"] {
        let rung = rungs.iter().find(|rung| stable.starts_with(rung["rung"].as_str().unwrap()));
        let told = rung.unwrap()["compiled_for"].as_array().unwrap();
        let shown = told.iter().find(|row| row["family"] == "navi31").unwrap();
        assert!(shown["ratio"].as_f64().unwrap() <= most, "{stable}: {shown}");
    }
    tables::hold_estimates(report);
}
