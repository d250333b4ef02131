//! `--why`: each effect, the reason why the scene needs it or not, and the saving of leaving it out.
//!
//! An effect that the scene needs is taken out of its pipeline, one that it does not need is put in; both are
//! timed against the scene's own pipeline in turns, and counted by a GPU's compiler.

use anyhow::Result;
use common::UsageError;
use common::app::{Args, Program, Run, RunHooks};
use common::gpu::PipelineDesc;
use common::output;
use instruments::Options;
use instruments::columns::columns;
use instruments::compare::{self, Comparison, Ratio};
use instruments::compile_for::{CompiledFor, Family, programs};
use instruments::idle;
use serde::Deserialize;

use crate::Demo;

/// Arguments of this chapter, beside every sample's.
#[derive(clap::Args)]
pub struct Why {
    /// Print each effect, why the scene needs it or not, and what leaving it out saves: milliseconds here, and
    /// instructions by Mesa's compiler for AMD's RDNA 3. A minute or more; --frames is the number of rounds
    #[arg(long)]
    why: bool,
}

/// Rounds of timing.
const ROUNDS: u32 = 9;
/// Size of the picture. On a GPU it is enlarged until its time can be measured.
const SIZE: [u32; 2] = [320, 200];
/// The family of GPUs whose compiler is run, and its name.
const FAMILY: (Family, &str) = (Family::Navi31, "RDNA 3");
/// Controls that the command sets itself.
const OWN: [(&str, &str); 4] = [
    ("pipeline", "specialised"),
    ("without", "nothing"),
    ("also", "nothing"),
    ("measure costs", "off"),
];

impl Why {
    /// Runs what the arguments request: prints the reasons, or does the same as every sample.
    ///
    /// # Errors
    /// Whatever went wrong.
    pub fn start(&self, name: &'static str, mut args: Args, options: Options) -> Result<()> {
        if !self.why || args.list_devices || args.list_controls {
            return instruments::start::<Demo>(name, &args, options);
        }
        check(&args, &options)?;
        if !args.frames_given {
            args.frames = ROUNDS;
        }
        if !args.size_given {
            [args.size.width, args.size.height] = SIZE;
        }
        args.headless = true;
        args.sets.extend(OWN.map(|(control, value)| (control.to_owned(), value.to_owned())));
        Program::of::<Demo>(name).start(&args, &mut Table)
    }
}

/// Refuses what goes with a picture alone.
fn check(args: &Args, options: &Options) -> Result<(), UsageError> {
    let taken = args.sets.iter().find(|(name, _)| OWN.iter().any(|(own, _)| own == name));
    let line = match taken {
        Some((name, _)) => format!("--why sets the control '{name}' itself; leave it out"),
        None if args.out.is_some() || args.animate || !args.then.is_empty() => {
            "--why makes no picture for --out, --animate or --then".to_owned()
        }
        None if !options.are_none() => {
            "--why prints a table of its own and takes none of the instruments' options".to_owned()
        }
        None => return Ok(()),
    };
    Err(UsageError(line))
}

/// An effect in the chapter's report.
#[derive(Clone, Debug, Deserialize)]
struct Reason {
    name: String,
    #[serde(rename = "in")]
    needed: bool,
    why: String,
}

/// The reordering of threads, in the chapter's report.
#[derive(Clone, Debug, Deserialize)]
struct Reordering {
    divergent: bool,
    why: String,
    offered: bool,
}

impl Reordering {
    /// The result in a line.
    fn line(&self) -> String {
        let Self { divergent, why, offered } = self;
        match (divergent, offered) {
            (true, true) => format!("Threads change places between rays: {why}."),
            (true, false) => format!(
                "Threads keep their places: this device lacks VK_EXT_ray_tracing_invocation_reorder. The scene is \
                 divergent: {why}."
            ),
            (false, _) => format!("Threads keep their places: {why}."),
        }
    }
}

/// A row of the table.
#[derive(Clone, Debug)]
struct Row {
    reason: Reason,
    /// Milliseconds that leaving it out saves; `None` where noise hides them.
    milliseconds: Option<f64>,
    /// The instructions that it saves; `None` if there is no such compiler.
    instructions: Option<i64>,
}

/// Measures and prints in place of a frame.
struct Table;

impl RunHooks for Table {
    fn has_result(&self) -> bool {
        true
    }

    fn begin(&mut self, run: &mut Run) -> Result<()> {
        idle::refuse(&run.gpu, "there are no times to compare")?;
        let report = run.sample.report()?;
        let reasons: Vec<Reason> = serde_json::from_value(report["effects"].clone())?;
        let (needed, others): (Vec<_>, Vec<_>) = reasons.iter().partition(|reason| reason.needed);
        // The pipelines are made in this order: the scene's own, one for each row, and that with everything.
        let without = timed(run, "without", &needed)?;
        let also = timed(run, "also", &others)?;
        let pipelines = ["specialised", "everything"].map(str::to_owned);
        let pipelines = compare::of_run(run, "pipeline", &pipelines, None)?;
        let compiled = instructions(run);
        let counts = compiled.as_deref().unwrap_or_default();
        let rows: Vec<Row> = reasons
            .iter()
            .map(|reason| {
                let same = |other: &&Reason| other.name == reason.name;
                let place = needed.iter().chain(&others).copied().position(|other| same(&other));
                let with = place.and_then(|place| counts.get(1 + place));
                let more = with.zip(counts.first()).map(|(with, own)| with - own);
                let comparison = if reason.needed { &without } else { &also };
                let cost =
                    comparison.as_ref().and_then(|comparison| cost(comparison, &reason.name));
                let sign = if reason.needed { -1.0 } else { 1.0 };
                Row {
                    reason: reason.clone(),
                    milliseconds: cost.map(|cost| sign * cost),
                    instructions: more.map(|more| if reason.needed { -more } else { more }),
                }
            })
            .collect();
        let reordering = Reordering::deserialize(&report["reordering"])?;
        output::print(&page(run, &rows, &pipelines, &compiled, &reordering))?;
        run.frames.clear();
        Ok(())
    }
}

/// The scene's own pipeline beside itself with each of these effects changed; `None` if there are none.
fn timed(run: &mut Run, control: &str, effects: &[&Reason]) -> Result<Option<Comparison>> {
    let names = effects.iter().map(|reason| reason.name.clone());
    let values: Vec<String> = ["nothing".to_owned()].into_iter().chain(names).collect();
    if effects.is_empty() {
        return Ok(None);
    }
    compare::of_run(run, control, &values, None).map(Some)
}

/// Milliseconds that a change adds to a frame; `None` if noise is as large.
fn cost(comparison: &Comparison, name: &str) -> Option<f64> {
    let own = comparison.values.first()?.milliseconds;
    let changed = comparison.values.iter().find(|measured| measured.value == name)?;
    let (ratio, noise) = (changed.ratio, comparison.noise);
    let differs = ratio.low > noise.high.max(1.0) || ratio.high < noise.low.min(1.0);
    differs.then_some(own * (ratio.median - 1.0))
}

/// Instructions of every pipeline of the run, in the order in which they were made.
fn instructions(run: &Run) -> Result<Vec<i64>> {
    let descs = run.gpu.statistics().descs.clone();
    let descs: Vec<&PipelineDesc> =
        descs.iter().map(|desc| &**desc).filter(|desc| desc.name == run.name).collect();
    let programs = programs(FAMILY.0, &descs)?;
    let count = |programs: &Vec<CompiledFor>| programs.iter().map(|p| p.instructions as i64).sum();
    Ok(programs.iter().map(count).collect())
}

/// Everything that the command prints.
fn page(
    run: &Run,
    rows: &[Row],
    pipelines: &Comparison,
    compiled: &Result<Vec<i64>>,
    reordering: &Reordering,
) -> String {
    let counts = compiled.as_deref().unwrap_or_default();
    let needed = rows.iter().filter(|row| row.reason.needed).count();
    let [own, all] = [counts.first(), counts.last()].map(|count| match count {
        Some(count) => format!(", {} instructions", grouped(*count)),
        None => String::new(),
    });
    let milliseconds = |place: usize| pipelines.values[place].milliseconds;
    let Ratio { low, median, high } = pipelines.values[1].ratio;
    let refused = compiled.as_ref().err();
    let refused = refused.map_or(String::new(), |why| format!("No instructions: {why:#}\n"));
    format!(
        "{} · {} · {} rounds\n\n\
         {needed} of {} effects, this scene's own pipeline: {:.1} ms a frame{own}\n\
         all of them in one pipeline: {:.1} ms a frame, {median:.2} times as long ({low:.2} to {high:.2}){all}\n\n\
         {}\n\
         ✓  called for: leaving it out would save this and change the picture\n\
         ✗  not called for: it is left out, which saves this and changes no pixel\n\
         Instructions are estimates by Mesa's compiler for {}; milliseconds were measured here.\n{refused}\
         {}\n",
        run.gpu.name,
        run.gpu.driver,
        pipelines.rounds,
        rows.len(),
        milliseconds(0),
        milliseconds(1),
        table(rows),
        FAMILY.1,
        reordering.line(),
    )
}

fn table(rows: &[Row]) -> String {
    let heading = ["", "effect", "because", "instructions saved", "ms saved"];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    lines.extend(rows.iter().map(|Row { reason, milliseconds, instructions }| {
        let mark = if reason.needed { "✓" } else { "✗" };
        let saved = milliseconds.map_or("noise".to_owned(), |saved| format!("{saved:.2}"));
        let instructions = instructions.map_or(String::new(), grouped);
        vec![mark.to_owned(), reason.name.clone(), reason.why.clone(), instructions, saved]
    }));
    columns(&lines, &[3, 4])
}

/// Digits by the thousand.
fn grouped(number: i64) -> String {
    let digits = number.unsigned_abs().to_string();
    let place = |at: usize| at > 0 && (digits.len() - at).is_multiple_of(3);
    let letters = digits.chars().enumerate();
    let digits = letters.flat_map(|(at, d)| place(at).then_some(',').into_iter().chain([d]));
    (number < 0).then_some('-').into_iter().chain(digits).collect()
}
