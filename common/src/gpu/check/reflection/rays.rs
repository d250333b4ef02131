//! A shader's use of rays, as far as mistakes are silent: its launch index, its outgoing and incoming payloads,
//! the hit attribute, and traces that cannot find anything.

use anyhow::{Result, ensure};
use rspirv::dr::{Function, Instruction, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass};

use super::Reflection;
use crate::gpu::pipeline::RayRecord;

/// `gl_RayFlagsOpaqueEXT`: no any-hit shader is called.
const OPAQUE: u32 = 1;

// Operand positions of `OpTraceRayKHR`; for a trace to a hit object, they follow that object.
const FLAGS: usize = 1;
const CULL_MASK: usize = 2;
const RECORD_OFFSET: usize = 3;
const RECORD_STRIDE: usize = 4;
const MISS_INDEX: usize = 5;
const TMIN: usize = 7;
const TMAX: usize = 9;

/// The payload of a trace.
#[derive(Debug, PartialEq, Eq)]
pub struct Passed {
    /// The trace's `missIndex`, if it is a constant.
    pub miss: Option<u32>,
    /// The payload's type.
    pub shape: String,
}

/// The payloads a shader passes to its rays and receives.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Payloads {
    /// The payloads of its traces.
    pub passed: Vec<Passed>,
    /// The types of its incoming payloads.
    pub taken: Vec<String>,
}

impl Reflection {
    /// Checks that a shader converts launch indices to pixels. A picture is traced in bands of rows, so a launch is
    /// a band: its index counts from the band's first row, which is in the raygen shader's record.
    ///
    /// # Errors
    /// If it reads the size of the launch, or its index in a function that does not add the band's first pixel.
    pub fn check_launch(&self, path: &str) -> Result<()> {
        let size = self.built_in(BuiltIn::LaunchSizeKHR);
        let index = self.built_in(BuiltIn::LaunchIdKHR);
        let record = self.variables(StorageClass::ShaderRecordBufferKHR);
        for function in &self.module.functions {
            // The log of `--pixel` compares the launch with the selected pixel.
            let name = function.def.as_ref().and_then(|def| def.result_id);
            if name.is_some_and(|id| self.debug_name(id, None).starts_with("log_")) {
                continue;
            }
            let reads = |ids: &[u32]| instructions(function).any(|i| names(i, ids));
            ensure!(
                !reads(&size),
                "{path}: gl_LaunchSizeEXT is the size of a band of the picture here; imageSize(picture) is the \
                 picture's"
            );
            ensure!(
                !reads(&index) || reads(&record),
                "{path}: gl_LaunchIDEXT counts from the first row of a band of the picture here; pixel_id() of \
                 common/band.glsl, called by the raygen shader, is the pixel"
            );
        }
        Ok(())
    }

    /// The outgoing and incoming payloads of the shader.
    pub fn payloads(&self) -> Payloads {
        let traces = self.traces();
        let passed = traces.filter_map(|trace| {
            let Some(Operand::IdRef(payload)) = trace.last() else { return None };
            let miss = self.constant(trace.get(MISS_INDEX));
            Some(Passed { miss, shape: self.shape_of(*payload)? })
        });
        let taken = self.used(StorageClass::IncomingRayPayloadKHR);
        Payloads { passed: passed.collect(), taken }
    }

    /// True if the shader traces rays.
    pub fn traces_rays(&self) -> bool {
        self.traces().next().is_some()
    }

    /// True if the shader has an outgoing payload, `rayPayloadEXT`.
    pub fn has_own_payload(&self) -> bool {
        !self.used(StorageClass::RayPayloadKHR).is_empty()
    }

    /// True if the shader reads push constants.
    pub fn has_push_constants(&self) -> bool {
        !self.variables(StorageClass::PushConstant).is_empty()
    }

    /// The type of the hit attribute that the shader uses, if it uses one.
    pub fn hit_attribute(&self) -> Option<String> {
        self.used(StorageClass::HitAttributeKHR).into_iter().next()
    }

    /// Checks that each ray names one of the pipeline's miss shaders, of which there are so many; any other index is
    /// undefined behaviour.
    ///
    /// # Errors
    /// If a constant `missIndex` is too large.
    pub fn check_misses(&self, path: &str, count: usize) -> Result<()> {
        for index in self.operands(MISS_INDEX) {
            ensure!(
                (index as usize) < count,
                "{path}: a ray has the missIndex {index}, and the pipeline has {count} miss shader{}, counted \
                 from 0 in the order of its .miss lines",
                if count == 1 { "" } else { "s" }
            );
        }
        Ok(())
    }

    /// Warnings: a ray whose mask excludes every instance, and one that ends before it begins.
    pub fn warnings(&self, path: &str) -> Vec<String> {
        let blind = self.operands(CULL_MASK).find(|mask| *mask == 0).map(|_| {
            format!("{path}: a ray has the cull mask 0, which every instance's mask hides from it")
        });
        let number = |operand: Option<&Operand>| self.constant(operand).map(f32::from_bits);
        let backward = self.traces().find_map(|trace| {
            let (tmin, tmax) = (number(trace.get(TMIN))?, number(trace.get(TMAX))?);
            (tmin > tmax).then_some((tmin, tmax))
        });
        let backward = backward.map(|(tmin, tmax)| {
            format!("{path}: a ray begins at tmin = {tmin:e} and ends before, at tmax = {tmax:e}: it hits nothing")
        });
        blind.into_iter().chain(backward).collect()
    }

    /// The rays whose part of a hit record's number is constant. Devices use four bits of each number.
    pub fn ray_records(&self, path: &str) -> Vec<RayRecord> {
        let rays = self.traces().filter_map(|trace| {
            Some(RayRecord {
                shader: path.to_owned(),
                offset: self.constant(trace.get(RECORD_OFFSET))? & 0xf,
                stride: self.constant(trace.get(RECORD_STRIDE))? & 0xf,
                flags: self.constant(trace.get(FLAGS)),
            })
        });
        rays.collect()
    }

    /// True if no ray of the shader can call an any-hit shader, according to its constant flags.
    pub fn traces_opaque_alone(&self) -> bool {
        self.traces()
            .all(|trace| self.constant(trace.get(FLAGS)).is_some_and(|flags| flags & OPAQUE != 0))
    }

    /// An operand of each trace, if it is a constant.
    fn operands(&self, place: usize) -> impl Iterator<Item = u32> {
        self.traces().filter_map(move |trace| self.constant(trace.get(place)))
    }

    /// The operands of each trace, from the top level on.
    fn traces(&self) -> impl Iterator<Item = &[Operand]> {
        let all = self.module.functions.iter().flat_map(instructions);
        all.filter_map(|i| match i.class.opcode {
            Op::TraceRayKHR => Some(&i.operands[..]),
            Op::HitObjectTraceRayEXT | Op::HitObjectTraceRayNV => i.operands.get(1..),
            _ => None,
        })
    }

    /// The variables with this built-in.
    fn built_in(&self, wanted: BuiltIn) -> Vec<u32> {
        let annotations = self.module.annotations.iter();
        let found = annotations.filter_map(|i| match i.operands.as_slice() {
            [
                Operand::IdRef(of),
                Operand::Decoration(Decoration::BuiltIn),
                Operand::BuiltIn(built_in),
            ] if *built_in == wanted => Some(*of),
            _ => None,
        });
        found.collect()
    }

    /// The variables of a storage class.
    fn variables(&self, wanted: StorageClass) -> Vec<u32> {
        let globals = self.module.types_global_values.iter();
        let variables = globals.filter(|i| {
            i.class.opcode == Op::Variable
                && i.operands.first() == Some(&Operand::StorageClass(wanted))
        });
        variables.filter_map(|i| i.result_id).collect()
    }

    /// The types of the variables of a storage class that a function uses.
    fn used(&self, class: StorageClass) -> Vec<String> {
        let used = |id: &u32| {
            self.module.functions.iter().flat_map(instructions).any(|i| names(i, &[*id]))
        };
        let variables = self.variables(class).into_iter().filter(used);
        variables.filter_map(|id| self.shape_of(id)).collect()
    }

    /// A variable's type, as text from [`Self::shape`].
    fn shape_of(&self, variable: u32) -> Option<String> {
        self.shape(self.pointee(variable)?)
    }

    fn global(&self, id: u32) -> Option<&Instruction> {
        self.module.types_global_values.iter().find(|i| i.result_id == Some(id))
    }

    /// A variable's type.
    fn pointee(&self, variable: u32) -> Option<u32> {
        match self.global(self.global(variable)?.result_type?)?.operands.as_slice() {
            [_, Operand::IdRef(pointee)] => Some(*pointee),
            _ => None,
        }
    }

    /// A type as text that is the same in every module, independent of the names of it and its members.
    fn shape(&self, id: u32) -> Option<String> {
        let global = self.global(id)?;
        let part = |operand: &Operand| match operand {
            Operand::IdRef(id) => self.shape(*id),
            Operand::LiteralBit32(number) => Some(number.to_string()),
            _ => Some(String::new()),
        };
        match global.class.opcode {
            // The structure at an address may refer back to this one.
            Op::TypePointer | Op::TypeForwardPointer => Some("address".to_owned()),
            Op::Constant => global.operands.first().and_then(part),
            opcode => {
                let parts: Option<Vec<String>> = global.operands.iter().map(part).collect();
                Some(format!("{opcode:?}({})", parts?.join(" ")))
            }
        }
    }

    /// The number of an operand that is a constant.
    fn constant(&self, operand: Option<&Operand>) -> Option<u32> {
        let Some(Operand::IdRef(id)) = operand else { return None };
        let global = self.global(*id)?;
        match (global.class.opcode, global.operands.as_slice()) {
            (Op::Constant, [Operand::LiteralBit32(number)]) => Some(*number),
            _ => None,
        }
    }
}

fn instructions(function: &Function) -> impl Iterator<Item = &Instruction> {
    function.blocks.iter().flat_map(|block| &block.instructions)
}

/// True if an instruction uses one of these ids.
fn names(i: &Instruction, ids: &[u32]) -> bool {
    i.operands.iter().any(|operand| matches!(operand, Operand::IdRef(id) if ids.contains(id)))
}
