//! `--compile-for`: a GPU compiler's statistics for a sample's pipelines, on a machine without that GPU.
//!
//! The sample runs on any device and creates its pipelines. Their descriptions are passed to a child process for
//! each family, in which Mesa's driver for it compiles them for an emulated card ([`absent`]). The numbers are that
//! compiler's estimates, not times.

pub mod absent;
mod card;
mod family;
mod figures;
mod table;

use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};

use absent::Answer;
use common::exit::child::{self, Crashed};
use common::gpu::{PipelineDesc, Requirements};
use common::output;

pub use card::{Variables, manifest, ways};
pub use family::{Family, INTEL, Maker, RADEON};
pub use figures::{CompiledFor, Figures, Intel, Radeon};
pub use table::table;

/// The options of `--compile-for`.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub struct Options {
    /// Also compile the pipelines with Mesa's compiler for this family of GPUs and print its statistics; no such GPU
    /// is needed
    #[arg(long, value_name = "FAMILY", value_enum)]
    pub compile_for: Option<Family>,

    /// Compile the pipelines on standard input for the family given there: the child process of --compile-for
    #[arg(long, hide = true)]
    pub answer_compile_for: bool,
}

/// The statistics of each family's compiler for these pipelines, each counted once: the rows of [`table`].
///
/// # Errors
/// If there is no such compiler (says what to install), or if it refuses a pipeline.
pub fn compile_for(family: Family, descs: &[Arc<PipelineDesc>]) -> Result<Vec<CompiledFor>> {
    let mut different: Vec<&PipelineDesc> = Vec::new();
    for desc in descs {
        if !different.contains(&&**desc) {
            different.push(desc);
        }
    }
    let mut pipelines = programs(family, &different)?;
    if pipelines.len() > 1 {
        for (number, programs) in pipelines.iter_mut().enumerate() {
            for program in programs {
                program.pipeline += &format!(" ({})", number + 1);
            }
        }
    }
    let mut all = pipelines.concat();
    let names = Family::All.names(true);
    let place = |row: &CompiledFor| names.iter().position(|name| *name == row.family);
    all.sort_by_key(place);
    Ok(all)
}

/// The statistics of each family's compiler for each pipeline: the programs of the first, of the second, and so
/// on. Each family has one child process, however many pipelines there are.
///
/// # Errors
/// As [`compile_for`].
pub fn programs(family: Family, descs: &[&PipelineDesc]) -> Result<Vec<Vec<CompiledFor>>> {
    let mut all = vec![Vec::new(); descs.len()];
    for &family in family.names(card::why_no_intel().is_none()) {
        let question = serde_json::to_vec(&(family, descs))?;
        let answer =
            ask(family, &question).with_context(|| format!("cannot compile for {family}"))?;
        ensure!(answer.pipelines.len() == all.len(), "{family}: too few pipelines were compiled");
        for ((rows, programs), desc) in all.iter_mut().zip(answer.pipelines).zip(descs) {
            for program in &programs {
                let name = desc.name.clone();
                rows.push(CompiledFor::new(family, &answer.compiler, name, program)?);
            }
        }
    }
    Ok(all)
}

/// The child's part: reads a family and pipelines from standard input, and prints the compiler's statistics.
///
/// # Errors
/// If it refuses.
pub fn answer(requirements: &Requirements) -> Result<()> {
    child::bind();
    let (family, descs): (String, Vec<PipelineDesc>) =
        serde_json::from_reader(std::io::stdin().lock())
            .context("no pipelines on standard input")?;
    if Maker::of(&family) == Maker::Intel {
        child::bound_memory(MOST_BYTES);
    }
    let answer = absent::compile(requirements, &family, &descs)?;
    output::print(&serde_json::to_string(&answer)?)
}

/// Memory of a process on an emulated Intel card. What such a card should have counted is not counted, and the driver
/// may believe any number.
const MOST_BYTES: u64 = 16 << 30;

fn ask(family: &str, question: &[u8]) -> Result<Answer> {
    let manifest = manifest(family)?;
    for way in ways(family)? {
        let mut command = child::command()?;
        command
            .arg("--answer-compile-for")
            .env("VK_DRIVER_FILES", &manifest)
            .env_remove("VK_ICD_FILENAMES")
            .env_remove("VK_INSTANCE_LAYERS")
            .env_remove("VULKAN_LOADER")
            .env_remove("RADV_FORCE_FAMILY")
            .envs(way);
        let answer = match child::ask(&mut command, question) {
            // drm-shim aborts the process if it does not know the card.
            Err(error) if error.downcast_ref().is_some_and(is_unknown) => continue,
            answer => answer?,
        };
        if let Some(answer) =
            serde_json::from_slice(&answer).context("the child process returned no result")?
        {
            return Ok(answer);
        }
    }
    if Maker::of(family) == Maker::Intel {
        bail!(
            "Mesa's driver here knows no such card: run ./setup, or install mesa-vulkan-drivers 25.0.7 or newer"
        );
    }
    let since = if family == "gfx1201" { "26.2.6" } else { "25.0.7" };
    bail!(
        "Mesa here stands in for no such card: run ./setup, or install drm-shim of Mesa {since} or newer, \
         on Debian the package mesa-drm-shim in the version of mesa-vulkan-drivers"
    )
}

fn is_unknown(crashed: &Crashed) -> bool {
    crashed.said.contains("Failed to find amdgpu GPU named")
}
