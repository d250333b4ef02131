//! Estimates of each rung by a GPU's own compiler, Mesa's RADV, for GPUs that are not installed.

use std::fmt::Write as _;

use anyhow::{Result, bail};
use common::app::Progress;
use common::gpu::PipelineDesc;
use instruments::compile_for::{Family, Radeon, programs};

use crate::measurement::{Compiled, MeasuredRung, Measurement};

/// The families, and so the children in which they are compiled.
pub const FAMILIES: [Family; 3] = [Family::Navi21, Family::Navi31, Family::Gfx1201];

/// The family that a single figure is of.
pub const SHOWN: &str = "navi31";

/// Clock and compiler disagree by more than this, or it is not worth a word.
pub const DISAGREE: f64 = 1.5;

/// Has the direct pipeline of every rung compiled for every family.
///
/// # Errors
/// If there is no such compiler, with a hint what to install, or if it refuses a rung.
pub fn compile(rungs: &mut [MeasuredRung], progress: &mut Progress) -> Result<()> {
    let mut rows: Vec<&mut MeasuredRung> =
        rungs.iter_mut().filter(|row| row.desc.is_some()).collect();
    let descs: Vec<&PipelineDesc> = rows.iter().filter_map(|row| row.desc.as_ref()).collect();
    let mut pipelines = Vec::new();
    for family in FAMILIES {
        pipelines.push(programs(family, &descs)?);
        progress.step();
    }
    for programs in pipelines {
        for (row, mut programs) in rows.iter_mut().zip(programs) {
            let (program, others) = (programs.pop(), programs.len());
            let (Some(program), 0) = (program, others) else {
                bail!("{} is made into {} programs", row.rung, others + 1);
            };
            row.compiled_for.push(Compiled { program, ratio: 0.0 });
        }
    }
    let cost = |compiled: &Compiled| figures(compiled).inverse_throughput.max(1) as f64;
    for ladder in rungs.chunk_by_mut(|a, b| a.primitive == b.primitive) {
        let families = ladder.iter().flat_map(|row| &row.compiled_for);
        let all: Vec<_> = families.map(|c| (c.program.family, cost(c))).collect();
        for compiled in ladder.iter_mut().flat_map(|row| &mut row.compiled_for) {
            let same = all.iter().filter(|(family, _)| *family == compiled.program.family);
            let least = same.map(|&(_, cost)| cost).fold(f64::INFINITY, f64::min);
            compiled.ratio = cost(compiled) / least;
        }
    }
    Ok(())
}

/// RADV's figures: all of [`FAMILIES`] are its.
fn figures(compiled: &Compiled) -> Radeon {
    compiled.program.radeon().cloned().unwrap_or_default()
}

/// Time and estimate of one rung.
pub struct Pair<'a> {
    pub row: &'a MeasuredRung,
    /// MeasuredRung time, and estimated inverse throughput on [`SHOWN`], over the least of the ladder each.
    pub time: f64,
    pub estimate: f64,
}

impl Pair<'_> {
    /// The ratio of the larger to the smaller.
    pub fn apart(&self) -> f64 {
        (self.estimate / self.time).max(self.time / self.estimate)
    }
}

/// A ladder's figures, of the families in their order.
pub fn table(ladder: &[MeasuredRung]) -> String {
    let Some(known) = ladder.iter().find(|row| !row.compiled_for.is_empty()) else {
        return String::new();
    };
    let families: Vec<_> = known.compiled_for.iter().map(|c| c.program.family).collect();
    let families = families.join(", ");
    let mut text = format!(
        "| rung | time / cheapest, measured here | inverse throughput / cheapest, estimated: {families} \
         | inverse throughput | instructions | registers |\n|---|--:|--:|--:|--:|--:|\n"
    );
    for row in ladder.iter().filter(|row| !row.compiled_for.is_empty()) {
        let all = |figure: &dyn Fn(&Compiled) -> String| {
            row.compiled_for.iter().map(figure).collect::<Vec<_>>().join(", ")
        };
        let time = row.time.map_or(String::new(), |time| format!("{:.2}", time.ratio.median));
        let ratios = all(&|c| format!("{:.2}", c.ratio));
        let throughput = all(&|c| figures(c).inverse_throughput.to_string());
        let instructions = all(&|c| c.program.instructions.to_string());
        let registers = all(&|c| figures(c).registers.to_string());
        let _ = writeln!(
            text,
            "| {} {} | {time} | {ratios} | {throughput} | {instructions} | {registers} |",
            row.rung, row.name
        );
    }
    text + "\n"
}

impl Measurement {
    /// All rungs that have both a time and an estimate.
    pub fn pairs(&self) -> Vec<Pair<'_>> {
        let mut pairs = Vec::new();
        for ladder in self.rungs.chunk_by(|a, b| a.primitive == b.primitive) {
            let time = |row: &MeasuredRung| row.time.map(|time| time.ratio.median);
            let least = ladder.iter().filter_map(time).fold(f64::INFINITY, f64::min);
            pairs.extend(ladder.iter().filter_map(|row| {
                let shown = row.compiled_for.iter().find(|c| c.program.family == SHOWN)?;
                Some(Pair { row, time: time(row)? / least, estimate: shown.ratio })
            }));
        }
        pairs
    }

    /// The rungs of which clock and compiler say different things, the farthest apart first.
    pub fn disagreements(&self) -> String {
        let mut rows = self.pairs();
        rows.retain(|pair| pair.apart() > DISAGREE);
        rows.sort_by(|a, b| b.apart().total_cmp(&a.apart()));
        if rows.is_empty() {
            return String::new();
        }
        let mut text = format!(
            "\n### Where clock and compiler disagree\n\nBy more than {DISAGREE} times, on {SHOWN}; both over the least of the ladder.\n\n\
             | rung | of | time / least, measured here | inverse throughput / least, estimated \
             | estimated / measured |\n|---|---|--:|--:|--:|\n"
        );
        for Pair { row, time, estimate } in rows {
            let _ = writeln!(
                text,
                "| {} {} | {} | {time:.2} | {estimate:.2} | {:.1} |",
                row.rung,
                row.name,
                row.primitive,
                estimate / time
            );
        }
        text
    }
}
