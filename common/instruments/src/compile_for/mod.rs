//! `--compile-for`: a GPU compiler's statistics for a sample's pipelines, on a machine without that GPU.
//!
//! The sample runs on any device and creates its pipelines. Their descriptions are passed to a child process for
//! each family, in which Mesa's RADV compiles them for an emulated card ([`absent`]). The numbers are that
//! compiler's estimates, not times.

pub mod absent;

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, bail, ensure};
use ash::vk;
use clap::ValueEnum;
use serde::Serialize;

use absent::Answer;
use common::gpu::{Executable, PipelineDesc, Requirements};
use common::output;

use common::exit::child::{self, Crashed};

/// The options of `--compile-for`.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub struct Options {
    /// Also compile the pipelines with Mesa's compiler for AMD GPUs and print its statistics; no such GPU is needed
    #[arg(long, value_name = "FAMILY", value_enum)]
    pub compile_for: Option<Family>,

    /// Compile the pipelines on standard input for the family given there: the child process of --compile-for
    #[arg(long, hide = true)]
    pub answer_compile_for: bool,
}

/// A GPU family for which RADV compiles ray tracing pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Family {
    /// RDNA2
    Navi21,
    /// RDNA3
    Navi31,
    /// RDNA4
    Gfx1201,
    /// All of them
    All,
}

impl Family {
    /// RADV's names of the selected families.
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Navi21 => &["navi21"],
            Self::Navi31 => &["navi31"],
            Self::Gfx1201 => &["gfx1201"],
            Self::All => &["navi21", "navi31", "gfx1201"],
        }
    }
}

/// RADV's statistics for one program of a pipeline. All numbers are its compiler's: comparable between similar
/// programs, but they are not times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CompiledFor {
    /// RADV's name for the family.
    pub family: &'static str,
    /// The driver of that compiler, with its version, on which the numbers depend.
    pub compiler: String,
    /// The pipeline, if the sample has several: its name and its number.
    pub pipeline: String,
    /// The driver's name for the program.
    pub executable: String,
    /// The stages in the program.
    pub stage: String,
    /// Vector registers per lane.
    pub registers: u64,
    /// Registers, scalar and vector, spilled to memory.
    pub spilled_registers: u64,
    /// Bytes of memory per wave, for spilled registers, stack and arrays.
    pub scratch_bytes: u64,
    /// Bytes of machine code.
    pub code_bytes: u64,
    /// Machine instructions.
    pub instructions: u64,
    /// Waves that one SIMD unit can hold at a time: more of them hide more latency.
    pub waves: u64,
    /// Invocations per wave.
    pub wave_size: u32,
    /// Estimated cycles from the program's start to its end, with loop counts assumed by the compiler.
    pub latency: u64,
    /// Estimated cycles between the ends of two waves when there are many.
    pub inverse_throughput: u64,
}

/// The statistics of each family's compiler for these pipelines, each counted once: the rows of [`table`].
///
/// # Errors
/// If there is no RADV (says what to install), or if it refuses a pipeline.
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
    let place = |row: &CompiledFor| family.names().iter().position(|name| *name == row.family);
    all.sort_by_key(place);
    Ok(all)
}

/// The statistics of each family's compiler for each pipeline: the programs of the first, of the second, and so
/// on. Each family has one child process, however many pipelines there are.
///
/// # Errors
/// As [`compile_for`].
pub fn programs(family: Family, descs: &[&PipelineDesc]) -> Result<Vec<Vec<CompiledFor>>> {
    let manifest = manifest()?;
    let mut all = vec![Vec::new(); descs.len()];
    for &family in family.names() {
        let question = serde_json::to_vec(&(family, descs))?;
        let answer = ask(family, &manifest, &question)
            .with_context(|| format!("cannot compile for {family}"))?;
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

/// The child's part: reads a family and pipelines from standard input, and prints RADV's statistics.
///
/// # Errors
/// If it refuses.
pub fn answer(requirements: &Requirements) -> Result<()> {
    child::bind();
    let (family, descs): (String, Vec<PipelineDesc>) =
        serde_json::from_reader(std::io::stdin().lock())
            .context("no pipelines on standard input")?;
    let answer = absent::compile(requirements, &family, &descs)?;
    output::print(&serde_json::to_string(&answer)?)
}

/// Environment variables that provide a card of this family to a child process, the best first: Mesa's drm-shim,
/// which the system's linker finds wherever it is installed, and RADV's own null hardware.
pub fn ways(family: &str) -> [Vec<(&'static str, OsString)>; 2] {
    let mut preloaded = OsString::from("libamdgpu_noop_drm_shim.so");
    if let Some(others) = std::env::var_os("LD_PRELOAD") {
        preloaded.push(":");
        preloaded.push(others);
    }
    [
        vec![("LD_PRELOAD", preloaded), ("AMDGPU_GPU_ID", family.into())],
        vec![("RADV_FORCE_FAMILY", family.into())],
    ]
}

fn ask(family: &str, manifest: &Path, question: &[u8]) -> Result<Answer> {
    for way in ways(family) {
        let mut command = child::command()?;
        command
            .arg("--answer-compile-for")
            .env("VK_DRIVER_FILES", manifest)
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
    let since = if family == "gfx1201" { "26.2.6" } else { "25.0.7" };
    bail!(
        "Mesa here stands in for no such card: run ./setup, or install drm-shim of Mesa {since} or newer, \
         on Debian the package mesa-drm-shim in the version of mesa-vulkan-drivers"
    )
}

fn is_unknown(crashed: &Crashed) -> bool {
    crashed.said.contains("Failed to find amdgpu GPU named")
}

/// The manifest with which the loader finds RADV.
///
/// # Errors
/// If there is none; says what to install.
pub fn manifest() -> Result<PathBuf> {
    // The loader's own search path: the variable replaces the usual folders.
    let shared = std::env::var("XDG_DATA_DIRS").unwrap_or_default();
    let shared = if shared.is_empty() { "/usr/local/share:/usr/share" } else { &shared };
    manifest_in(["/etc"].into_iter().chain(shared.split(':').filter(|folder| !folder.is_empty())))
}

/// RADV's manifest in one of these configuration and shared-data folders.
fn manifest_in<'a>(folders: impl Iterator<Item = &'a str>) -> Result<PathBuf> {
    let mut manifests: Vec<PathBuf> = folders
        .filter_map(|folder| Path::new(folder).join("vulkan/icd.d").read_dir().ok())
        .flat_map(|entries| entries.flatten().map(|entry| entry.path()))
        .collect();
    // With several architectures there is one for each: radeon_icd.x86_64.json.
    let fit = format!("radeon_icd.{}.json", std::env::consts::ARCH);
    manifests.sort();
    let named = |wanted: &str| manifests.iter().find(|path| path.ends_with(wanted)).cloned();
    named(&fit).or_else(|| named("radeon_icd.json")).ok_or_else(|| {
        anyhow!(
            "figures of a GPU's compiler need Mesa's Vulkan driver for AMD (RADV), which is not installed: \
             run ./setup, or install mesa-vulkan-drivers on Debian, Ubuntu or Fedora, vulkan-radeon on Arch"
        )
    })
}

impl CompiledFor {
    fn new(
        family: &'static str,
        compiler: &str,
        pipeline: String,
        program: &Executable,
    ) -> Result<Self> {
        let figure = |name: &str| {
            let value = program.figure(name).map(|value| value as u64);
            value.with_context(|| format!("{compiler} does not report '{name}'"))
        };
        Ok(Self {
            family,
            compiler: compiler.to_owned(),
            pipeline,
            executable: program.name.clone(),
            stage: stages(program.stages),
            registers: figure("VGPRs")?,
            spilled_registers: figure("Spilled SGPRs")? + figure("Spilled VGPRs")?,
            scratch_bytes: figure("Scratch size")?,
            code_bytes: figure("Code size")?,
            instructions: figure("Instructions")?,
            waves: figure("Subgroups per SIMD")?,
            wave_size: program.subgroup_size,
            latency: figure("Latency")?,
            inverse_throughput: figure("Inverse Throughput")?,
        })
    }
}

/// The names of the stages in `VkShaderStageFlags`.
fn stages(flags: u32) -> String {
    let names = [
        (vk::ShaderStageFlags::RAYGEN_KHR, "raygen"),
        (vk::ShaderStageFlags::MISS_KHR, "miss"),
        (vk::ShaderStageFlags::CLOSEST_HIT_KHR, "closest hit"),
        (vk::ShaderStageFlags::ANY_HIT_KHR, "any-hit"),
        (vk::ShaderStageFlags::INTERSECTION_KHR, "intersection"),
        (vk::ShaderStageFlags::CALLABLE_KHR, "callable"),
        (vk::ShaderStageFlags::COMPUTE, "compute"),
        (vk::ShaderStageFlags::VERTEX, "vertex"),
        (vk::ShaderStageFlags::FRAGMENT, "fragment"),
    ];
    let flags = vk::ShaderStageFlags::from_raw(flags);
    let found = names.into_iter().filter(|(flag, _)| flags.contains(*flag));
    found.map(|(_, name)| name).collect::<Vec<_>>().join(" + ")
}

/// The statistics as a table, readable as text and as Markdown.
pub fn table(rows: &[CompiledFor]) -> String {
    let mut text = String::from(
        "| family | pipeline | program | stage | registers | spilled | scratch, bytes | code, bytes \
         | instructions | waves | latency | inverse throughput |\n|---|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for row in rows {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} of {} | {} | {} |",
            row.family,
            row.pipeline,
            row.executable,
            row.stage,
            row.registers,
            row.spilled_registers,
            row.scratch_bytes,
            row.code_bytes,
            row.instructions,
            row.waves,
            row.wave_size,
            row.latency,
            row.inverse_throughput
        );
    }
    let compiler = rows.first().map_or("", |row| &row.compiler);
    let _ = writeln!(
        text,
        "\nEstimates of a compiler for AMD GPUs, {compiler}: comparable between programs of one shape, no \
         times."
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_is_found_where_a_loader_looks_and_a_missing_one_says_what_to_install() {
        let folder = std::env::temp_dir().join(format!("manifests-{}", std::process::id()));
        let place = folder.join("vulkan/icd.d");
        std::fs::create_dir_all(&place).unwrap();
        let shared = || ["/nonexistent", folder.to_str().unwrap()].into_iter();
        let write = |name: &str| std::fs::write(place.join(name), "{}").unwrap();
        let found = || manifest_in(shared()).map(|path| path.file_name().unwrap().to_owned());
        write("lvp_icd.json");
        let refused = found().unwrap_err().to_string();
        assert!(refused.contains("install mesa-vulkan-drivers"), "{refused}");
        write("radeon_icd.json");
        assert_eq!(found().unwrap(), "radeon_icd.json");
        // With several architectures, this program's own.
        let own = format!("radeon_icd.{}.json", std::env::consts::ARCH);
        write("radeon_icd.i686.json");
        write(&own);
        assert_eq!(found().unwrap(), *own);
        std::fs::remove_dir_all(folder).unwrap();
    }
}
