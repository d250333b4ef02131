//! Every case of a file through every rung, directly and traced.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Result, ensure};
use common::app::Progress;
use common::files::write_whole;
use common::gpu::Gpu;
use common::output;
use serde::Serialize;

use crate::batch::Batch;
use crate::cases::{self, Case};
use crate::judge::{Judgement, Verdict, judge};
use crate::ladder::{Code, Primitive, Rung};
use crate::probe::{Probe, Way};
use crate::shape::Shape;

/// Traced, a top rung must be right where no coordinate of the ray's origin is larger than this. Farther
/// away the device's own box test decides.
const RANGE: f32 = 1e7;

/// Results of a run of a case file.
#[derive(Serialize)]
struct Findings {
    file: String,
    device: String,
    driver: String,
    /// The arithmetic of the shaders: the value of `--arithmetic`.
    arithmetic: String,
    /// True if `fma()` rounds once here.
    fused: bool,
    cases: usize,
    /// The number of cases that were not run although the device has the rung. Any is a failure.
    skipped: usize,
    /// The largest coordinate of the origins for which traced answers have to meet the bound.
    traced_within: f32,
    rungs: Vec<Row>,
    answers: Vec<Line>,
    /// Errors of top rungs.
    failures: Vec<String>,
    validation_messages: Vec<String>,
}

/// One rung, one way.
#[derive(Serialize)]
struct Row {
    primitive: &'static str,
    rung: &'static str,
    name: &'static str,
    way: &'static str,
    top: bool,
    /// The reason why the device lacks it.
    #[serde(skip_serializing_if = "Option::is_none")]
    unavailable: Option<String>,
    cases: usize,
    run: usize,
    right: usize,
    inexact: usize,
    false_hits: usize,
    false_misses: usize,
    never_offered: usize,
    not_finite: usize,
    /// The largest error of t among hits that are hits, in ULP.
    worst_ulp: f64,
}

/// One case by one rung, one way.
#[derive(Serialize)]
struct Line {
    case: String,
    primitive: String,
    family: String,
    rung: &'static str,
    way: &'static str,
    #[serde(flatten)]
    judgement: Judgement,
}

fn name(way: Way) -> &'static str {
    match way {
        Way::Direct => "direct",
        Way::Traced => "traced",
    }
}

/// Runs every case of the file through all rungs, or those that must be right, and writes what was found to `report`.
///
/// # Errors
/// If the file is wrong, the device fails, a top rung is wrong, or a case was left out.
pub fn run(gpu: &Gpu, path: &Path, tops: bool, report: Option<&Path>) -> Result<()> {
    let cases = cases::read(path)?;
    let probe = Probe::new(gpu)?;
    let mut findings = Findings {
        file: path.display().to_string(),
        device: gpu.name.clone(),
        driver: gpu.driver.clone(),
        arithmetic: gpu.driver_shim.name().to_owned(),
        fused: probe.fused,
        cases: cases.len(),
        skipped: 0,
        traced_within: RANGE,
        rungs: Vec::new(),
        answers: Vec::new(),
        failures: Vec::new(),
        validation_messages: Vec::new(),
    };
    let rungs: usize = Primitive::ALL.iter().map(|p| 2 * p.ladder().len()).sum();
    let mut progress = Progress::new(rungs as u64, "rungs");
    for primitive in Primitive::ALL {
        let own: Vec<&Case> =
            cases.iter().filter(|case| case.shape.primitive() == primitive).collect();
        if own.is_empty() {
            continue;
        }
        let shapes: Vec<Shape> = own.iter().map(|case| case.shape.clone()).collect();
        let asked: Vec<_> = own.iter().enumerate().map(|(i, case)| (i, case.ray)).collect();
        let batch = Batch::new(gpu, &shapes, &asked, primitive.is_traced())?;
        for rung in primitive.ladder().iter().filter(|rung| !tops || rung.is_held(gpu)) {
            for way in [Way::Direct, Way::Traced] {
                progress.step();
                let has_way = match way {
                    Way::Direct => rung.code != Code::Device,
                    Way::Traced => primitive.is_traced(),
                };
                if has_way {
                    findings.ask(gpu, &probe, &batch, rung, way, &own)?;
                }
            }
        }
    }
    drop(progress);
    let answered = findings.rungs.iter().filter(|row| row.unavailable.is_none());
    findings.skipped = answered.map(|row| row.cases - row.run).sum();
    findings.validation_messages = gpu.validation().all();
    findings.write(report)?;
    ensure!(findings.skipped == 0, "{} answers are missing", findings.skipped);
    ensure!(
        findings.failures.is_empty(),
        "top rungs are wrong {} times; the first: {}",
        findings.failures.len(),
        findings.failures[0]
    );
    Ok(())
}

impl Findings {
    fn ask(
        &mut self,
        gpu: &Gpu,
        probe: &Probe,
        batch: &Batch,
        rung: &'static Rung,
        way: Way,
        cases: &[&Case],
    ) -> Result<()> {
        let primitive = cases[0].shape.primitive();
        let mut row = Row {
            primitive: primitive.name(),
            rung: rung.label,
            name: rung.name,
            way: name(way),
            top: rung.is_held(gpu),
            unavailable: rung.unavailable(gpu),
            cases: cases.len(),
            run: 0,
            right: 0,
            inexact: 0,
            false_hits: 0,
            false_misses: 0,
            never_offered: 0,
            not_finite: 0,
            worst_ulp: 0.0,
        };
        if row.unavailable.is_none() {
            let instrument = probe.instrument(primitive, rung, way)?;
            let answers = probe.ask(&instrument, batch)?;
            for (case, answer) in cases.iter().zip(&answers) {
                let Case { shape, ray, expected, tolerance, .. } = case;
                let judgement = judge(shape, ray, expected, tolerance, way, answer);
                row.add(&judgement);
                let is_held = rung.is_held(gpu)
                    && (way == Way::Direct || ray.origin.abs().max_element() <= RANGE);
                if is_held && judgement.verdict != Verdict::Right {
                    self.failures.push(format!(
                        "{} {} {}: {:?} {}",
                        case.id, rung.label, row.way, judgement.verdict, judgement.why
                    ));
                }
                self.answers.push(Line {
                    case: case.id.clone(),
                    primitive: case.primitive.clone(),
                    family: case.family.clone(),
                    rung: rung.label,
                    way: row.way,
                    judgement,
                });
            }
        }
        self.rungs.push(row);
        Ok(())
    }

    fn write(&self, report: Option<&Path>) -> Result<()> {
        let json = serde_json::to_string_pretty(self)? + "\n";
        match report {
            Some(path) if path == Path::new("-") => output::print(&json),
            Some(path) => {
                write_whole(path, json.as_bytes())?;
                output::print(&self.table())
            }
            None => output::print(&self.table()),
        }
    }

    fn table(&self) -> String {
        let Self { device, driver, arithmetic, cases, .. } = self;
        let mut text = format!("{device} · {driver} · {cases} cases · arithmetic {arithmetic}\n\n");
        text += "| primitive | rung | way | run | right | inexact | false hits | false misses \
                 | never offered | worst t, ULP |\n|---|---|---|---|---|---|---|---|---|---|\n";
        for row in &self.rungs {
            let Row { primitive, rung, name, way, .. } = row;
            if let Some(why) = &row.unavailable {
                let _ =
                    writeln!(text, "| {primitive} | {rung} {name} | {way} | unavailable: {why} |");
                continue;
            }
            let _ = writeln!(
                text,
                "| {primitive} | {rung} {name} | {way} | {} | {} | {} | {} | {} | {} | {} |",
                row.run,
                row.right,
                row.inexact,
                row.false_hits,
                row.false_misses,
                row.never_offered,
                short(row.worst_ulp),
            );
        }
        text
    }
}

impl Row {
    fn add(&mut self, judgement: &Judgement) {
        self.run += 1;
        match judgement.verdict {
            Verdict::Right => self.right += 1,
            Verdict::Inexact => self.inexact += 1,
            Verdict::FalseHit => self.false_hits += 1,
            Verdict::FalseMiss => self.false_misses += 1,
            Verdict::NeverOffered => self.never_offered += 1,
            Verdict::NotFinite => self.not_finite += 1,
        }
        let counts = matches!(judgement.verdict, Verdict::Right | Verdict::Inexact);
        if let Some(ulp) = judgement.ulp.filter(|_| counts) {
            self.worst_ulp = self.worst_ulp.max(ulp);
        }
    }
}

/// Three digits, whatever the size.
pub fn short(x: f64) -> String {
    match x {
        0.0 => "0".to_owned(),
        x if (0.01..10.0).contains(&x) => format!("{x:.2}"),
        x if (10.0..1e4).contains(&x) => format!("{x:.0}"),
        x => format!("{x:.1e}"),
    }
}
