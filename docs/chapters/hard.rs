//! `cargo chapters hard`: runs hard cases and random rays through the textbook's formulas and ours on this
//! device.
//!
//! Chapter 24 computes and checks; this command draws a seed, runs it twice and prints a summary.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};
use clap::Args;
use common::UsageError;
use common::files::NewFolder;
use common::output::print;
use instruments::columns::columns;
use manuscript::project::Project;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use time_limit::Limit;

use crate::programs::child;
use crate::programs::program::Programs;
use crate::programs::ready;

/// The chapter that measures accuracy, and its hard cases.
const LABORATORY: &str = "24_accuracy";
const CASES: &str = "tests/data/hard_cases.json";

/// Each primitive, its textbook rung, and the rung that must always be right.
const RUNGS: [(&str, &str, &str); 14] = [
    ("sphere", "S0", "S4"),
    ("box", "B0", "B3"),
    ("plane", "P0", "P3"),
    ("triangle", "T1", "T3"),
    ("capsule", "C0", "C2"),
    ("instance", "I0", "I2"),
    ("heightfield", "H0", "H3"),
    ("secondary origin", "O2", "O5"),
    ("accumulation", "A0", "A3"),
    ("cone", "K0", "K2"),
    ("quadric", "Q0", "Q2"),
    ("patch", "L0", "L2"),
    ("voxel", "V1", "V3"),
    ("algebraic", "F0", "F3"),
];

/// The primitive whose sums are not random.
const SUMS: &str = "accumulation";
/// The primitive of rays that leave a surface. Only the object they hit matters, and it may be as close as
/// the initial step.
const LEAVING: &str = "secondary origin";

/// The arguments of `cargo chapters hard`.
#[derive(Debug, Args)]
pub struct HardArguments {
    /// Draw the random rays from this seed, 1 to 4294967295 [default: another one each time]
    #[arg(long, value_name = "N", value_parser = seed, allow_hyphen_values = true)]
    seed: Option<u32>,
    /// Random rays of each family, 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = rays, allow_hyphen_values = true)]
    rays: u32,
    /// Print a row for each family, instead of one for each shape
    #[arg(long)]
    families: bool,
    /// Use this device: a number of --list-devices or a part of its name
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
}

fn seed(text: &str) -> Result<u32, String> {
    let known = text.parse().ok().filter(|&seed| seed > 0);
    known.ok_or_else(|| format!("a seed is a whole number from 1 to {}", u32::MAX))
}

fn rays(text: &str) -> Result<u32, String> {
    let known = text.parse().ok().filter(|rays| (1..=100_000).contains(rays));
    known.ok_or_else(|| "rays are a whole number from 1 to 100000".to_owned())
}

/// The results of 24 on the hard cases.
#[derive(Deserialize)]
struct HardCases {
    device: String,
    driver: String,
    rungs: Vec<HardRung>,
    failures: Vec<String>,
}

#[derive(Deserialize)]
struct HardRung {
    rung: String,
    name: String,
    way: String,
    unavailable: Option<String>,
    run: u64,
    right: u64,
    worst_ulp: f64,
}

/// The results of 24 on random rays.
#[derive(Deserialize)]
struct RandomRays {
    rungs: Vec<RandomRung>,
}

#[derive(Deserialize)]
struct RandomRung {
    rung: String,
    errors: Vec<Errors>,
}

#[derive(Deserialize)]
struct Errors {
    family: String,
    way: String,
    rays: u64,
    max: f64,
    far_off: u64,
    false_hits: u64,
    false_misses: u64,
    not_finite: u64,
    miscounted: u64,
}

impl Errors {
    fn wrong(&self, primitive: &str) -> u64 {
        let far_off = if primitive == LEAVING { 0 } else { self.far_off };
        far_off + self.false_hits + self.false_misses + self.not_finite + self.miscounted
    }

    fn most(&self, primitive: &str) -> f64 {
        if primitive == LEAVING { 0.0 } else { self.max }
    }
}

/// A row of the table.
#[derive(Debug, Default, PartialEq)]
struct Row {
    family: String,
    rays: u64,
    textbook: u64,
    /// `None` if the device lacks what this rung needs.
    ours: Option<u64>,
    /// The largest error of ours, in ULP.
    most: f64,
}

impl HardArguments {
    /// Runs the command.
    ///
    /// # Errors
    /// If 24 fails, or ours is wrong.
    pub fn run(&self, project: &Project) -> Result<()> {
        let programs = Programs::beside_this(project)?;
        ready::build(&programs, &[LABORATORY])?;
        let seed = self.seed.unwrap_or_else(fresh);
        let folder = NewFolder::temporary()?;
        let cases = self.cases(&programs, folder.path())?;
        let random = self.random(&programs, folder.path(), seed)?;
        let rows = [hard_rows(&cases)?, random_rows(&random, self.families)?];
        print(&page(&cases, &rows, seed))?;
        verdict(&cases, &rows, seed)
    }

    fn command(&self, programs: &Programs) -> Result<Command> {
        let mut command = programs.built(LABORATORY)?;
        if let Some(shaders) = std::env::var_os("SHADERS") {
            command.env("SHADERS", shaders);
        }
        command.arg("--headless");
        command.args(self.device.iter().flat_map(|device| ["--device", device]));
        Ok(command)
    }

    /// The hard cases. If a top rung is wrong, 24 fails, but only after writing its results.
    fn cases(&self, programs: &Programs, folder: &Path) -> Result<HardCases> {
        let file = folder.join("cases.json");
        let mut command = self.command(programs)?;
        command.args(["--cases", CASES, "--report"]).arg(&file);
        run(&mut command, &file, "hard cases")
    }

    fn random(&self, programs: &Programs, folder: &Path, seed: u32) -> Result<RandomRays> {
        let mut command = self.command(programs)?;
        command.args(["--rounds", "0", "--rungs-alone", "--rays", &self.rays.to_string()]);
        command.args(["--seed", &seed.to_string()]);
        let primitives = RUNGS.iter().map(|(primitive, ..)| primitive).filter(|&&p| p != SUMS);
        command.args(primitives.flat_map(|primitive| ["--only", primitive]));
        run(command.arg("--measure").arg(folder), &folder.join("accuracy.json"), "random rays")
    }
}

/// Runs 24 and reads its results; if there are none, returns its own error.
fn run<Answers: DeserializeOwned>(
    command: &mut Command,
    file: &Path,
    what: &str,
) -> Result<Answers> {
    let ended = child::run_saying(command, Limit::NONE, what)?;
    let Ok(text) = std::fs::read_to_string(file) else {
        match (ended.refused(), ended.failed()) {
            (Some(line), _) => bail!(UsageError(line)),
            (None, Some(line)) => bail!("{what}: {line}"),
            (None, None) => bail!("{what}: {LABORATORY} has written no report"),
        }
    };
    serde_json::from_str(&text).with_context(|| format!("{what}: its report"))
}

/// A random seed.
fn fresh() -> u32 {
    (RandomState::new().build_hasher().finish() as u32).max(1)
}

/// A row for each primitive, called directly.
fn hard_rows(cases: &HardCases) -> Result<Vec<Row>> {
    let rung = |label: &str| {
        let found = cases.rungs.iter().find(|row| row.rung == label && row.way == "direct");
        found.with_context(|| format!("{LABORATORY} has no rung {label}"))
    };
    let row = |&(primitive, textbook, ours): &(&str, &str, &str)| {
        let (textbook, ours) = (rung(textbook)?, rung(ours)?);
        Ok(Row {
            family: primitive.to_owned(),
            rays: textbook.run,
            textbook: textbook.run - textbook.right,
            ours: ours.unavailable.is_none().then(|| ours.run - ours.right),
            most: if primitive == LEAVING { 0.0 } else { ours.worst_ulp },
        })
    };
    RUNGS.iter().map(row).collect()
}

/// A row for each primitive or, if `families`, for each family.
fn random_rows(random: &RandomRays, families: bool) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (primitive, textbook, ours) in RUNGS.iter().filter(|(primitive, ..)| *primitive != SUMS) {
        let errors = |label: &str| {
            let found = random.rungs.iter().find(|row| row.rung == label);
            let found = found.with_context(|| format!("{LABORATORY} has no rung {label}"))?;
            Ok::<_, anyhow::Error>(found.errors.iter().filter(|row| row.way == "direct"))
        };
        let ours: Vec<&Errors> = errors(ours)?.collect();
        let mut own: Vec<Row> = errors(textbook)?
            .map(|errors| {
                let ours = ours.iter().find(|row| row.family == errors.family);
                Row {
                    family: errors.family.clone(),
                    rays: errors.rays,
                    textbook: errors.wrong(primitive),
                    ours: ours.map(|row| row.wrong(primitive)),
                    most: ours.map_or(0.0, |row| row.most(primitive)),
                }
            })
            .collect();
        if !families {
            own = vec![sum(primitive, &own)];
        }
        rows.extend(own);
    }
    Ok(rows)
}

fn sum(family: &str, rows: &[Row]) -> Row {
    Row {
        family: family.to_owned(),
        rays: rows.iter().map(|row| row.rays).sum(),
        textbook: rows.iter().map(|row| row.textbook).sum(),
        ours: rows.iter().map(|row| row.ours).sum(),
        most: rows.iter().map(|row| row.most).fold(0.0, f64::max),
    }
}

/// The command's whole output.
fn page(cases: &HardCases, rows: &[Vec<Row>; 2], seed: u32) -> String {
    let [hard, random] = rows.each_ref().map(|rows| rows.iter().map(|row| row.rays).sum::<u64>());
    let names = |pick: fn(&(&'static str, &'static str, &'static str)) -> &'static str| {
        let name = |label: &str| cases.rungs.iter().find(|row| row.rung == label);
        let labels = RUNGS.iter().map(pick);
        let named = labels.map(|l| format!("{l} {}", name(l).map_or("", |row| &*row.name)));
        named.collect::<Vec<_>>().join(", ")
    };
    format!(
        "{} · {}\n{} hard cases, and {} random rays from seed {seed}\n\n{}\n{}\n\
         Wrong: a hit instead of a miss or a miss instead of a hit, a distance off by more than 1,000 ULP (about a\n\
         ten-thousandth), a number that is not finite, or a cone, quadric, patch, voxel or algebraic surface met\n\
         more or less often than it should be; of rays that leave a surface (secondary origin) only what they meet\n\
         counts. A hard case is also wrong beyond its tolerance, mostly 1 ULP.\n\
         Textbook: {}.\nOurs: {}.\nThe same rays again: cargo chapters hard --seed {seed}\n",
        cases.device,
        cases.driver,
        grouped(hard),
        grouped(random),
        table("hard cases", &rows[0]),
        table("random rays", &rows[1]),
        names(|rung| rung.1),
        names(|rung| rung.2),
    )
}

fn table(what: &str, rows: &[Row]) -> String {
    let heading = [what, "rays", "wrong by the textbook", "wrong by ours", "ours off by, ULP"];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    let total = sum("all", rows);
    for row in rows.iter().chain([&total]) {
        let (ours, most) = match row.ours {
            Some(wrong) => (grouped(wrong), format!("{:.2}", row.most)),
            None => ("not offered".to_owned(), String::new()),
        };
        let most = if row.most == 0.0 { String::new() } else { most };
        lines.push(vec![row.family.clone(), grouped(row.rays), grouped(row.textbook), ours, most]);
    }
    columns(&lines, &[1, 2, 3, 4])
}

/// A number with commas between thousands.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let place = |at: usize| at > 0 && (digits.len() - at).is_multiple_of(3);
    let letters = digits.chars().enumerate();
    letters.flat_map(|(at, digit)| place(at).then_some(',').into_iter().chain([digit])).collect()
}

/// Fails if ours was wrong or never tested.
fn verdict(cases: &HardCases, rows: &[Vec<Row>; 2], seed: u32) -> Result<()> {
    let all = || rows.iter().flatten();
    if let Some(failure) = cases.failures.first() {
        bail!("ours is wrong in {} hard cases; the first: {failure}", cases.failures.len());
    }
    if let Some(row) = all().find(|row| row.ours.is_some_and(|wrong| wrong > 0)) {
        let wrong: u64 = all().filter_map(|row| row.ours).sum();
        bail!("ours is wrong {wrong} times from seed {seed}; first of '{}'", row.family);
    }
    if all().all(|row| row.ours.is_none()) {
        bail!("this device offers none of our formulas what they need");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Results with 3 wrong cases for the textbook and `wrong` for ours; without ours if that is `None`.
    fn cases(wrong: Option<u64>) -> HardCases {
        let row = |primitive: &str, rung: &str, wrong: Option<u64>| {
            json!({
                "primitive": primitive, "rung": rung, "name": "a name", "way": "direct", "run": 9,
                "right": wrong.map(|wrong| 9 - wrong).unwrap_or_default(), "worst_ulp": 0.5,
                "unavailable": wrong.is_none().then_some("no rounding"),
            })
        };
        let rungs =
            RUNGS.map(|(p, textbook, ours)| [row(p, textbook, Some(3)), row(p, ours, wrong)]);
        let report = json!({
            "device": "D", "driver": "V", "rungs": rungs.concat(), "failures": [],
        });
        serde_json::from_value(report).expect("cases")
    }

    fn random(wrong: u64) -> RandomRays {
        let errors = |family: &str, wrong: u64| {
            json!({
                "family": family, "way": "direct", "rays": 1000, "max": 0.25, "far_off": wrong,
                "false_hits": wrong, "false_misses": 0, "not_finite": 0, "miscounted": 0,
            })
        };
        let rung = |label: &str, wrong: u64| json!({ "rung": label, "errors": [errors("near", 0), errors("far", wrong)] });
        let rungs = RUNGS.map(|(_, textbook, ours)| [rung(textbook, 2), rung(ours, wrong)]);
        serde_json::from_value(json!({ "rungs": rungs.concat() })).expect("rays")
    }

    #[test]
    fn a_table_has_a_row_for_each_shape_or_each_family() {
        let rows = hard_rows(&cases(Some(0))).expect("rows");
        let family = "sphere".to_owned();
        let first = Row { family, rays: 9, textbook: 3, ours: Some(0), most: 0.5 };
        assert_eq!((rows.len(), &rows[0]), (14, &first));
        let rows = random_rows(&random(0), false).expect("rows");
        let family = "sphere".to_owned();
        let first = Row { family, rays: 2000, textbook: 4, ours: Some(0), most: 0.25 };
        assert_eq!((rows.len(), &rows[0]), (13, &first));
        assert_eq!(random_rows(&random(0), true).expect("rows").len(), 26);
        let text = page(&cases(Some(0)), &[hard_rows(&cases(Some(0))).expect("rows"), rows], 7);
        for line in [
            "126 hard cases, and 26,000 random rays from seed 7",
            "all               26,000                     50              0              0.25",
        ] {
            assert!(text.lines().any(|told| told == line), "no '{line}' in:\n{text}");
        }
    }

    #[test]
    fn one_wrong_answer_of_ours_is_an_error_and_none_at_all_as_well() {
        let told = |hard: Option<u64>, by_chance: u64| {
            let cases = cases(hard);
            let hard = hard_rows(&cases).expect("rows");
            let random = random_rows(&random(by_chance), false).expect("rows");
            verdict(&cases, &[hard, random], 7).map_err(|error| error.to_string())
        };
        assert_eq!(told(Some(0), 0), Ok(()));
        let line = "ours is wrong 25 times from seed 7; first of 'sphere'";
        assert_eq!(told(Some(0), 1), Err(line.to_owned()));
        let line = "ours is wrong 14 times from seed 7; first of 'sphere'";
        assert_eq!(told(Some(1), 0), Err(line.to_owned()));
        let none = verdict(&cases(None), &[hard_rows(&cases(None)).expect("rows"), vec![]], 7);
        assert!(none.is_err());
    }

    #[test]
    fn seeds_and_rays_are_whole_numbers_and_digits_stand_by_the_thousand() {
        assert_eq!((seed("7"), rays("2000")), (Ok(7), Ok(2000)));
        for wrong in ["0", "-1", "x", "4294967296"] {
            assert!(seed(wrong).is_err() && rays(wrong).is_err(), "{wrong}");
        }
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        assert_ne!(fresh(), fresh());
    }
}
