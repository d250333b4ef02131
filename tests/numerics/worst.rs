//! The hard cases and the random families in the worst conforming arithmetic: each top rung meets the same
//! bound as on the driver itself.

use run::expected;
use serde_json::{Value, json};

use crate::bars::{Row, report};
use crate::hard::is_own;
use crate::laboratory;
use crate::tables::{Table, ladders, text};

/// The rungs that rely on 64-bit floats: Vulkan only promises the precision of 32 bits for them.
const NEED_64_BITS: [&str; 9] = ["S5", "B4", "P4", "C3", "K3", "Q3", "L3", "V4", "F4"];

/// The ladders tested with random rays, for their two-float rung or a similar one. For that rung of a capsule,
/// a cone or an instance, the driver's compiler needs more than ten seconds, so these have only hard cases.
const MEASURED: [&str; 11] = [
    "sphere",
    "box",
    "plane",
    "triangle",
    "heightfield",
    "secondary origin",
    "accumulation",
    "quadric",
    "patch",
    "voxel",
    "algebraic",
];

/// Rays per family.
const RAYS: &str = "300";

/// The arithmetics, named as in the page's tables.
const ARITHMETICS: [&str; 3] = ["driver", "worst", "worst-by-place"];

/// The shapes whose two-float rung the driver's compiler takes too long for by day.
const BY_NIGHT: [&str; 5] = ["cone", "quadric", "patch", "voxel", "algebraic"];

const FILE: &str = "tests/data/hard_cases.json";

/// The hard cases of these shapes, or of all others, in a file of their own; their number.
fn some(is_by_night: bool) -> (tempfile::TempDir, String, usize) {
    let stored = std::fs::read_to_string(run::root().join(FILE)).expect("the cases");
    let mut all: Value = serde_json::from_str(&stored).expect("JSON");
    let list = all["cases"].as_array_mut().expect("cases");
    list.retain(|case| BY_NIGHT.contains(&text(case, "primitive")) == is_by_night);
    let count = list.len();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("some.json");
    std::fs::write(&path, all.to_string()).expect("it can be written");
    let path = path.to_str().expect("a plain name").to_owned();
    (folder, path, count)
}

fn cases(file: &str, arithmetic: &str, more: &[&str]) -> Value {
    let of = ["--cases", file, "--report", "-", "--arithmetic", arithmetic];
    let output = laboratory(&[&of, more].concat());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arithmetic}: {errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    assert_eq!(report["validation_messages"], serde_json::json!([]));
    assert_eq!(report["arithmetic"], arithmetic);
    report
}

fn every_hard_case_is_right(arithmetic: &str, is_by_night: bool) {
    if !run::has_worst_arithmetic() {
        return;
    }
    let (_folder, file, count) = some(is_by_night);
    let report = cases(&file, arithmetic, &["--tops"]);
    let known = if is_by_night { 192 } else { 114 };
    assert_eq!((count, &report["cases"], &report["skipped"]), (known, &known.into(), &0.into()));
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
    // S4, B3, P3, T3, C2, I2, H3 and O5 direct and traced, A3 only direct; by night K2, Q2, L2, V3 and F3, both ways.
    let known = if is_by_night { 2 * 5 } else { 2 * 8 + 1 };
    assert_eq!(tops.len(), known, "{tops:?}");
}

fn every_family_is_right(arithmetic: &str) {
    if !run::has_worst_arithmetic() {
        return;
    }
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
            // H3 marches in 32 bits, so it may hit hills that a ray nearly touches. Its t is only checked on
            // its home family.
            let is_home = row.0["family"] == "hills at 60°";
            assert!(label == "H3" && !is_home || row.number("false_hits") == 0.0, "{place}");
            match label {
                "H3" => assert!(!is_home || p99 <= 8.0, "{place}: {p99}"),
                // A departure is right or wrong, and has no error in ULP.
                "O5" => {}
                _ => assert!(most <= 1.0, "{place}: {most}"),
            }
            families += 1;
        }
    }
    // Direct and traced: 7 for spheres, 4 for boxes, 4 for planes, 5 for triangles, 5 for heightfields, 5 for
    // quadrics, 6 for patches, 5 for voxels and 7 for algebraic surfaces; only direct: 9 for origins and 3 for sums.
    assert_eq!(families, 2 * 48 + 9 + 3);
}

#[test]
fn every_top_rung_is_right_in_the_worst_arithmetic() {
    every_hard_case_is_right("worst", false);
}

#[test]
#[ignore = "nightly: compiles for long; quick: worst::every_top_rung_is_right_in_the_worst_arithmetic"]
fn cones_and_what_has_many_roots_are_right_in_the_worst_arithmetic() {
    every_hard_case_is_right("worst", true);
}

#[test]
#[ignore = "nightly: compiles for long; quick: worst::every_top_rung_is_right_in_the_worst_arithmetic"]
fn every_top_rung_is_right_where_copies_of_a_formula_disagree() {
    every_hard_case_is_right("worst-by-place", false);
    every_hard_case_is_right("worst-by-place", true);
}

#[test]
#[ignore = "nightly: random rays; quick: worst::every_top_rung_is_right_in_the_worst_arithmetic"]
fn every_top_rung_keeps_its_bar_on_random_rays() {
    every_family_is_right("worst");
}

#[test]
#[ignore = "nightly: compiles for long; quick: worst::every_top_rung_is_right_in_the_worst_arithmetic"]
fn so_it_does_where_copies_of_a_formula_disagree() {
    every_family_is_right("worst-by-place");
}

/// The page's table, and its statement about the smallest direction.
#[test]
#[ignore = "by hand: asks every rung for a table of the page, for minutes"]
fn the_hard_cases_of_every_rung_in_each_arithmetic() {
    let reports = ARITHMETICS.map(|arithmetic| cases(FILE, arithmetic, &[]));
    let all = reports.each_ref().map(|report| ladders(report));
    let mut table = Table::new();
    for (number, (shape, rows)) in all[0].iter().enumerate() {
        table.insert(format!("{shape}.cases"), rows[0]["cases"].clone());
        for (at, row) in rows.iter().enumerate().filter(|(_, row)| is_own(row)) {
            for (arithmetic, ladders) in ARITHMETICS.iter().zip(&all) {
                let right = ladders[number].1[at]["right"].clone();
                table.insert(format!("{}.{arithmetic}", text(row, "rung")), right);
            }
        }
    }
    expected::hold("arithmetic/hard_cases", table.into());

    let answers = reports[1]["answers"].as_array().unwrap().iter();
    let smallest =
        answers.filter(|answer| answer["case"] == "sph_dirscale_1e-20" && is_own(answer));
    let smallest: Vec<&Value> = smallest.collect();
    let of = |rung: &str| smallest.iter().find(|answer| answer["rung"] == rung).unwrap();
    assert_eq!(
        (&of("S0")["verdict"], &of("S4")["verdict"]),
        (&json!("not-finite"), &json!("right"))
    );
    let off = |rung: &&str| of(rung)["ulp"].as_f64();
    let off = ["S0h", "S1", "S2", "S3"].iter().filter_map(off).fold(0.0, f64::max);
    let misses = ["S0h", "S1", "S2", "S3"].iter().filter(|rung| of(rung)["hit"] == false).count();
    expected::hold("arithmetic/smallest", json!({ "off": off, "misses": misses }));
}

/// The page's table: for each ladder, the largest p99 and the largest error of its families.
#[test]
#[ignore = "by hand: asks thousands of rays for a table of the page, for minutes"]
fn random_rays_in_each_arithmetic() {
    let rows = |report: &Value| -> Vec<(String, Vec<Row>)> {
        let of = |(shape, ladder): (&str, &[Value])| {
            // On the driver, a ladder with 64 bits has two top rungs.
            let [rung, ..] = ladder else { panic!("no rung of {shape}") };
            let rows = rung["errors"].as_array().unwrap().iter();
            (shape.to_owned(), rows.map(|row| Row(row.clone())).collect())
        };
        ladders(report).into_iter().map(of).collect()
    };
    let reports = ARITHMETICS
        .map(|arithmetic| rows(&report(&["--tops", "--rays", "1000", "--arithmetic", arithmetic])));
    let (mut table, mut departures, mut wrong) = (Table::new(), 0.0, 0.0);
    for (number, (shape, rows)) in reports[0].iter().enumerate() {
        let rays: f64 = rows.iter().map(|row| row.number("rays")).sum();
        let is_about_t = shape != "secondary origin";
        if is_about_t {
            table.insert(format!("{shape}.rays"), (rays as u64).into());
        } else {
            departures = rays;
        }
        for (arithmetic, report) in ARITHMETICS.iter().zip(&reports) {
            let rows = &report[number].1;
            let faults = ["never_offered", "not_finite"];
            wrong += rows.iter().map(Row::wrong).sum::<f64>();
            wrong += faults
                .map(|key| rows.iter().map(|row| row.number(key)).sum::<f64>())
                .iter()
                .sum::<f64>();
            // Three sums have no p99.
            let keys: &[&str] = if shape == "accumulation" { &["max"] } else { &["p99", "max"] };
            for key in keys.iter().filter(|_| is_about_t) {
                let most = rows.iter().map(|row| row.number(key)).fold(0.0, f64::max);
                table.insert(format!("{shape}.{arithmetic}.{key}"), most.into());
            }
        }
    }
    expected::hold("arithmetic/random_rays", table.into());
    let found = json!({ "departures": departures as u64, "wrong": wrong as u64 });
    expected::hold("arithmetic/faults", found);
}
