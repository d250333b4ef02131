//! The costs of all rungs: the times on the pages, and their plots.

use run::expected;
use serde_json::{Value, json};

use crate::tables::{Table, head, ladders, span, text};
use crate::unwatched;

/// The clock and the compiler agree within this factor.
const AGREE: f64 = 1.5;

/// The ladders that one run times, so that the page can compare them.
const FIRST: [&str; 9] = [
    "sphere",
    "box",
    "plane",
    "triangle",
    "capsule",
    "instance",
    "heightfield",
    "secondary origin",
    "accumulation",
];

/// One run measures all times, so that they can be compared; with `FIGURES`, it also draws the plots.
#[test]
#[ignore = "by hand: takes times, for minutes"]
fn every_rung_is_timed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let place = folder.path().to_str().expect("a temporary folder has a plain name");
    let only = FIRST.into_iter().flat_map(|name| ["--only", name]);
    let output = unwatched(&["--measure", place].into_iter().chain(only).collect::<Vec<_>>());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = std::fs::read_to_string(folder.path().join("accuracy.json")).expect("it is there");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    expected::give_timed("24_accuracy/times", times(&report).into());
    if std::env::var_os("FIGURES").is_some() {
        for (plot, page) in [("accuracy", "24_measured"), ("accuracy_compiled", "24_compiled")] {
            let to = run::root().join(format!("docs/images/{page}.png"));
            std::fs::copy(folder.path().join(format!("{plot}.png")), to).expect("a plot");
        }
    }
}

/// Cones and quadrics have a run of their own.
#[test]
#[ignore = "by hand: takes times, for minutes"]
fn cones_and_quadrics_are_timed() {
    give_times("24_accuracy/root_times", &["--only", "cone", "--only", "quadric"]);
}

/// So have patches and voxels.
#[test]
#[ignore = "by hand: takes times, for minutes"]
fn patches_and_voxels_are_timed() {
    give_times("24_accuracy/patch_times", &["--only", "patch", "--only", "voxel"]);
}

/// So have algebraic surfaces.
#[test]
#[ignore = "by hand: takes times, for minutes"]
fn algebraic_surfaces_are_timed() {
    give_times("24_accuracy/algebraic_times", &["--only", "algebraic"]);
}

fn give_times(name: &str, only: &[&str]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let place = folder.path().to_str().expect("a temporary folder has a plain name");
    let output = unwatched(&[&["--measure", place], only].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = std::fs::read_to_string(folder.path().join("accuracy.json")).expect("it is there");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    expected::give_timed(name, times(&report).into());
}

fn times(report: &Value) -> Table {
    let mut table = Table::new();
    for (shape, ladder) in ladders(report) {
        for rung in ladder.iter().filter(|rung| !rung["time"].is_null()) {
            let head = head(&[text(rung, "rung"), text(rung, "name")]);
            let time = &rung["time"];
            table.extend(ratio(&head, &time["ratio"]));
            table.insert(format!("{head}.millions"), time["millions_a_second"].clone());
            for march in rung["marches"].as_array().expect("marches") {
                let name =
                    format!("{}.{}", text(march, "family").replace(' ', "-"), text(rung, "rung"));
                table.insert(name, march["ratio"]["median"].clone());
            }
        }
        let noise = ladder.iter().find_map(|rung| rung["time"].get("noise")).expect("noise");
        let again = format!("the cheapest {shape} again (noise)");
        table.extend(ratio(&again.replace(' ', "-"), noise));
    }
    for form in report["forms"].as_array().expect("forms") {
        let head = head(&[text(form, "name")]);
        table.insert(format!("{head}.build"), form["build_milliseconds"].clone());
        table.insert(format!("{head}.time"), form["ratio"]["median"].clone());
    }
    for (kind, [least, most]) in span(&table, ".ratio") {
        table.insert(format!("{kind}.least"), least.into());
        table.insert(format!("{kind}.most"), most.into());
    }
    table.extend(disagreement(report));
    table
}

fn ratio(head: &str, ratio: &Value) -> [(String, Value); 3] {
    let parts = [("ratio", "median"), ("low", "low"), ("high", "high")];
    parts.map(|(key, part)| (format!("{head}.{key}"), ratio[part].clone()))
}

/// Each rung's time and estimate for navi31 relative to the least of its ladder, and the ratio of the two.
fn disagreement(report: &Value) -> Table {
    let (mut table, mut all, mut agree) = (Table::new(), 0, 0);
    for (_, ladder) in ladders(report) {
        let time = |rung: &Value| rung["time"]["ratio"]["median"].as_f64();
        let least = ladder.iter().filter_map(time).fold(f64::INFINITY, f64::min);
        for rung in ladder {
            let Some(time) = time(rung) else { continue };
            let mut families = rung["compiled_for"].as_array().expect("families").iter();
            let family = families.find(|family| family["family"] == "navi31").expect("navi31");
            let (time, estimate) = (time / least, family["ratio"].as_f64().expect("a ratio"));
            let head = head(&[text(rung, "rung"), text(rung, "name")]);
            table.insert(format!("{head}.over_least"), time.into());
            table.insert(format!("{head}.apart"), (estimate / time).into());
            all += 1;
            agree += u32::from((estimate / time).max(time / estimate) <= AGREE);
        }
    }
    table.insert("programs".to_owned(), json!(all));
    table.insert("agree".to_owned(), json!(agree));
    table
}
