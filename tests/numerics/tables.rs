//! The tables of the pages, from a report of chapter 24. A row's figures are named after its head on the
//! page, with hyphens: `S0-textbook.home`.

use run::expected;
use serde_json::{Map, Value};

use crate::bars::Row;

/// A table's figures by name, in the order of the page.
pub type Table = Map<String, Value>;

/// The page's name of a rung or a family.
pub fn head(words: &[&str]) -> String {
    words.join(" ").replace(' ', "-")
}

pub fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_else(|| panic!("no {key} in {value}"))
}

/// The rungs of a report by ladder, each with the shape's name.
pub fn ladders(report: &Value) -> Vec<(&str, &[Value])> {
    let rungs = report["rungs"].as_array().expect("rungs");
    let ladders = rungs.chunk_by(|a, b| a["primitive"] == b["primitive"]);
    ladders.map(|ladder| (text(&ladder[0], "primitive"), ladder)).collect()
}

fn rows(rung: &Value) -> impl Iterator<Item = Row> {
    rung["errors"].as_array().into_iter().flatten().map(|row| Row(row.clone()))
}

/// Compares all errors that the pages print.
pub fn hold_errors(report: &Value) {
    let mut rungs = Table::new();
    let is_of_page = is_of_page(report);
    for (shape, ladder) in ladders(report) {
        for rung in ladder.iter().filter(|rung| rows(rung).next().is_some()) {
            rungs.extend(home_and_hardest(rung, is_of_page));
        }
        match shape {
            "secondary origin" => {
                expected::hold("24_accuracy/departures", departures(ladder).into())
            }
            _ => {
                let name = format!("24_accuracy/{shape}_errors");
                expected::hold(&name, errors(ladder).into());
                if COUNTED.contains(&shape) {
                    expected::hold(&format!("24_accuracy/{shape}_right"), right(ladder).into());
                }
            }
        }
    }
    rungs.insert("planet.gain".to_owned(), gain(report).into());
    expected::hold("24_accuracy/rungs", rungs.into());
    let mut forms = Table::new();
    for form in report["forms"].as_array().expect("forms") {
        let head = head(&[text(form, "name")]);
        let keys = ["lost", "depth", "p99", "bytes"];
        forms.extend(keys.map(|key| (format!("{head}.{key}"), form[key].clone())));
    }
    expected::hold("24_accuracy/forms", forms.into());
}

/// A rung on its home family, and on the hardest family for it: the one with the most wrong rays, then the
/// one with the largest p99. There is no error if no ray hits.
fn home_and_hardest(rung: &Value, is_of_page: bool) -> Table {
    let asked: Vec<Row> = rows(rung).filter(|row| is_own(rung, row)).collect();
    let part = |row: &Row| row.wrong() / row.number("rays");
    let hardness = |row: &Row| (part(row), row.number("p99"));
    let hardest = asked.iter().max_by(|a, b| {
        let ((a, b), (c, d)) = (hardness(a), hardness(b));
        a.total_cmp(&c).then(b.total_cmp(&d))
    });
    let (home, hardest) = (&asked[0], hardest.expect("a family"));
    let head = head(&[text(rung, "rung"), text(rung, "name")]);
    let mut table = Table::new();
    let mut add = |key: &str, value: f64| table.insert(format!("{head}.{key}"), value.into());
    add("p50", home.number("p50"));
    add("p99", home.number("p99"));
    add("wrong", home.wrong());
    if part(hardest) < 1.0 {
        add("there", hardest.number("p99"));
    }
    add("part", part(hardest));
    if is_of_page {
        let none = part(hardest) == 0.0 && hardest.number("p99") < 0.505;
        page_names(rung, if none { "none" } else { text(&hardest.0, "family") });
    }
    table
}

/// Returns whether a row is for its rung called directly, or for the device's own triangles, which can only
/// be traced.
fn is_own(rung: &Value, row: &Row) -> bool {
    let way = if text(rung, "rung") == "T0" { "traced" } else { "direct" };
    row.0["way"] == way
}

/// The factor by which computing c on the host reduces the p99 of the textbook's sphere on a planet.
fn gain(report: &Value) -> f64 {
    let [textbook, host] = ["S0", "S0h"].map(|label| {
        let mut rungs = report["rungs"].as_array().expect("rungs").iter();
        let rung = rungs.find(|rung| rung["rung"] == label).expect("a rung of spheres");
        let mut asked = rows(rung).filter(|row| is_own(rung, row));
        let planet = asked.find(|row| row.0["family"] == "planet of 1e6 from 1 above");
        planet.expect("the planet").number("p99")
    });
    textbook / host
}

/// Returns whether the page's figures come from this device.
fn is_of_page(report: &Value) -> bool {
    expected::stored("24_accuracy/rungs")["device"] == report["device"]
}

/// Checks that both pages name a rung's hardest family, or none if it has half a ULP everywhere.
fn page_names(rung: &Value, family: &str) {
    let start = format!("| {} {} |", text(rung, "rung"), text(rung, "name"));
    // The chapter shows a part of a ladder, and its origins have a table of all families.
    let is_of_origins = text(rung, "primitive") == "secondary origin";
    for (name, has_all) in [("docs/measured.md", !is_of_origins), ("docs/24_accuracy.md", false)] {
        let page = std::fs::read_to_string(run::root().join(name)).expect("a page");
        let rows = page.lines().filter(|line| line.starts_with(&start) && line.contains('%'));
        let rows: Vec<&str> = rows.collect();
        assert!(!rows.is_empty() || !has_all, "{name}: {start} … | {family} |");
        let is_named = |row: &&str| row.contains(&format!(" | {family} | "));
        assert!(is_of_origins || rows.iter().all(is_named), "{name}: {start} … | {family} |");
    }
}

/// Every family for every rung; traced rays where they differ from direct ones.
fn errors(ladder: &[Value]) -> Table {
    let mut families = Vec::new();
    for row in ladder.iter().flat_map(rows) {
        let family = text(&row.0, "family").to_owned();
        if !families.contains(&family) {
            families.push(family);
        }
    }
    let keys = ["p50", "p99", "max", "false_misses", "false_hits", "never_offered"];
    let found = |row: &Row| keys.map(|key| row.number(key));
    let mut table = Table::new();
    for (family, rung) in families.iter().flat_map(|f| ladder.iter().map(move |rung| (f, rung))) {
        let rows: Vec<Row> = rows(rung).filter(|row| row.0["family"] == **family).collect();
        for row in &rows {
            let is_direct = |row: &Row| row.0["way"] == "direct";
            let same = |other: &Row| is_direct(other) && found(other) == found(row);
            if !is_direct(row) && rows.iter().any(same) {
                continue;
            }
            let head = head(&[family, text(rung, "rung"), text(&row.0, "way")]);
            table.extend(keys.map(|key| (format!("{head}.{key}"), row.0[key].clone())));
        }
    }
    table
}

/// Shapes whose rungs say how often a ray meets them.
const COUNTED: [&str; 5] = ["cone", "quadric", "patch", "voxel", "algebraic"];

/// The share of right answers by family and rung: hit or miss, the number of hits, and t to 1,000 ULP.
fn right(ladder: &[Value]) -> Table {
    let mut table = Table::new();
    for rung in ladder {
        for row in rows(rung).filter(|row| is_own(rung, row)) {
            let wrong = ["far_off", "not_finite", "miscounted"].map(|key| row.number(key));
            let wrong = row.wrong() + wrong.iter().sum::<f64>();
            let name = format!("{}.{}", head(&[text(&row.0, "family")]), text(rung, "rung"));
            table.insert(name, (1.0 - (wrong / row.number("rays")).min(1.0)).into());
        }
    }
    table
}

/// The number of rays that hit their sphere again, or missed the plane in the gap.
fn departures(ladder: &[Value]) -> Table {
    let mut table = Table::new();
    for (number, family) in rows(&ladder[0]).enumerate() {
        let head = head(&[text(&family.0, "family")]);
        table.insert(format!("{head}.rays"), family.0["rays"].clone());
        for rung in ladder {
            let Some(row) = rows(rung).nth(number) else { continue };
            table.insert(format!("{head}.{}", text(rung, "rung")), (row.wrong() as u64).into());
        }
    }
    table
}

/// Compares a GPU compiler's estimates.
pub fn hold_estimates(report: &Value) {
    let compiler = text(report, "compiler");
    let mut table = Table::new();
    for rung in report["rungs"].as_array().expect("rungs") {
        let head = head(&[text(rung, "rung"), text(rung, "name")]);
        for family in rung["compiled_for"].as_array().expect("families") {
            let name = text(family, "family");
            for key in ["ratio", "inverse_throughput", "instructions", "registers"] {
                table.insert(format!("{head}.{name}.{key}"), family[key].clone());
            }
        }
    }
    for (kind, [least, most]) in span(&table, ".navi31.ratio") {
        table.insert(format!("{kind}.least"), least.into());
        table.insert(format!("{kind}.most"), most.into());
    }
    let generations = "RDNA2, RDNA3, RDNA4";
    expected::hold_compiled("24_accuracy/estimates", compiler, generations, table.into());
}

/// The least and the largest cost of rungs in two-floats, and in 64 bits.
pub fn span(table: &Table, key: &str) -> [(&'static str, [f64; 2]); 2] {
    ["two-float", "64-bits"].map(|kind| {
        let end = format!("-{kind}{key}");
        let own = table.iter().filter(|(name, _)| name.ends_with(&end));
        let values: Vec<f64> = own.map(|(_, value)| value.as_f64().expect("a number")).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        (kind, [least, values.into_iter().fold(0.0, f64::max)])
    })
}
