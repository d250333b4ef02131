//! A compiler's statistics for one program, by the names that versions of Mesa have for them.

use anyhow::{Context, Result};
use ash::vk;
use common::gpu::Executable;
use serde::Serialize;

use super::family::Maker;

/// A compiler's statistics for one program of a pipeline: comparable between similar programs, but they are not times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CompiledFor {
    /// Mesa's name for the family.
    pub family: &'static str,
    /// The driver of that compiler, with its version, on which the numbers depend.
    pub compiler: String,
    /// The pipeline, if the sample has several: its name and its number.
    pub pipeline: String,
    /// The driver's name for the program.
    pub executable: String,
    /// The stages in the program.
    pub stage: String,
    /// Machine instructions.
    pub instructions: u64,
    /// The other statistics of this maker's compiler.
    #[serde(flatten)]
    pub figures: Figures,
}

/// The statistics that only one maker's compiler has.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Figures {
    /// RADV's.
    Radeon(Radeon),
    /// ANV's.
    Intel(Intel),
}

/// RADV's statistics.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Radeon {
    /// Vector registers per lane.
    pub registers: u64,
    /// Registers, scalar and vector, spilled to memory.
    pub spilled_registers: u64,
    /// Bytes of memory per wave, for spilled registers, stack and arrays.
    pub scratch_bytes: u64,
    /// Bytes of machine code.
    pub code_bytes: u64,
    /// Waves that one SIMD unit can hold at a time: more of them hide more latency.
    pub waves: u64,
    /// Invocations per wave.
    pub wave_size: u32,
    /// Estimated cycles from the program's start to its end, with loop counts assumed by the compiler.
    pub latency: u64,
    /// Estimated cycles between the ends of two waves when there are many.
    pub inverse_throughput: u64,
}

/// ANV's statistics. It cuts a shader at each trace, and reports only what precedes the first (`brw_compile_bs.cpp`:
/// "Figure out shader stats etc. for resume shaders"). Its "Scratch Memory Size" is another program's in Mesa 25.0.7,
/// and left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Intel {
    /// Invocations that run in step: SIMD8, SIMD16.
    pub simd: u32,
    /// Messages to memory, textures and the ray tracing unit; `None` if this Mesa does not count them.
    pub sends: Option<u64>,
    /// The most registers of 32 bytes that hold values at one time.
    pub live_registers: u64,
    /// Registers of 32 bytes that a program has on this family.
    pub of_registers: u64,
    /// Instructions that write a spilled register to memory.
    pub spills: u64,
    /// Instructions that read one back.
    pub fills: u64,
}

impl CompiledFor {
    /// The statistics of a program, read by their names.
    ///
    /// # Errors
    /// If the driver does not report one of them.
    pub(super) fn new(
        family: &'static str,
        compiler: &str,
        pipeline: String,
        program: &Executable,
    ) -> Result<Self> {
        // Of several names, the older Mesa's first.
        let figure = |names: &[&str]| {
            let value = names.iter().find_map(|name| program.figure(name));
            let value = value.map(|value| value as u64);
            value.with_context(|| format!("{compiler} does not report '{}'", names[0]))
        };
        let (instructions, figures) = match Maker::of(family) {
            Maker::Amd => (
                figure(&["Instructions"])?,
                Figures::Radeon(Radeon {
                    registers: figure(&["VGPRs"])?,
                    spilled_registers: figure(&["Spilled SGPRs"])? + figure(&["Spilled VGPRs"])?,
                    scratch_bytes: figure(&["Scratch size"])?,
                    code_bytes: figure(&["Code size"])?,
                    waves: figure(&["Subgroups per SIMD"])?,
                    wave_size: program.subgroup_size,
                    latency: figure(&["Latency"])?,
                    inverse_throughput: figure(&["Inverse Throughput"])?,
                }),
            ),
            Maker::Intel => (
                figure(&["Instruction Count", "Instructions"])?,
                Figures::Intel(Intel {
                    simd: program.subgroup_size,
                    sends: figure(&["SEND Count", "Sends", "Send messages"]).ok(),
                    live_registers: figure(&["Max live registers"])?,
                    // Xe2 has as many, each twice as large.
                    of_registers: if family == "dg2" { 128 } else { 256 },
                    spills: figure(&["Spill Count", "Spills"])?,
                    fills: figure(&["Fill Count", "Fills"])?,
                }),
            ),
        };
        Ok(Self {
            family,
            compiler: compiler.to_owned(),
            pipeline,
            executable: program.name.clone(),
            stage: stages(program.stages),
            instructions,
            figures,
        })
    }

    /// RADV's own statistics, if the family is one of AMD's.
    pub fn radeon(&self) -> Option<&Radeon> {
        if let Figures::Radeon(figures) = &self.figures { Some(figures) } else { None }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn program(statistics: &[(&str, f64)]) -> Executable {
        let statistics = statistics.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
        Executable { name: "raygen".to_owned(), stages: 0x100, subgroup_size: 16, statistics }
    }

    #[test]
    fn both_versions_of_mesa_tell_the_same_by_other_names() {
        let older = [
            ("Instruction Count", 900.0),
            ("SEND Count", 40.0),
            ("Spill Count", 2.0),
            ("Fill Count", 3.0),
            ("Max live registers", 206.0),
            ("Scratch Memory Size", 99.0),
        ];
        let newer = [
            ("Instructions", 900.0),
            ("Sends", 40.0),
            ("Spills", 2.0),
            ("Fills", 3.0),
            ("Max live registers", 206.0),
        ];
        let [older, newer] = [&older[..], &newer[..]].map(|statistics| {
            CompiledFor::new("bmg", "ANV", String::new(), &program(statistics)).unwrap()
        });
        assert_eq!(older, newer);
        let Figures::Intel(figures) = older.figures else { panic!("{older:?}") };
        assert_eq!((figures.live_registers, figures.of_registers), (206, 256));
    }

    #[test]
    fn a_statistic_that_is_missing_is_named() {
        let refused = CompiledFor::new("dg2", "ANV", String::new(), &program(&[])).unwrap_err();
        assert_eq!(refused.to_string(), "ANV does not report 'Instruction Count'");
    }
}
