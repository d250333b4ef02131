//! Contents of a shader module: its stage, its calls, and the sizes of its payloads.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Op, StorageClass};
use serde::Serialize;

use common::gpu::Reflection;

/// A module in figures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Contents {
    /// The stage: the execution model of its entry point.
    pub stage: String,
    /// Number of places that trace a ray.
    pub traces: usize,
    /// Number of places that report a hit.
    pub reports: usize,
    /// True if it reads a texture.
    pub samples: bool,
    /// Bytes of the largest payload, a scalar taken for 4.
    pub payload: usize,
}

impl Contents {
    /// Collects the contents of a module.
    pub fn of(reflection: &Reflection) -> Self {
        let module = &reflection.module;
        let count = |op: Op| instructions(module).filter(|i| i.class.opcode == op).count();
        let entry = module.entry_points.first().and_then(|entry| entry.operands.first());
        let stage = match entry {
            Some(Operand::ExecutionModel(model)) => format!("{model:?}"),
            _ => String::new(),
        };
        Self {
            stage: stage.trim_end_matches("KHR").to_owned(),
            traces: count(Op::TraceRayKHR),
            reports: count(Op::ReportIntersectionKHR),
            samples: count(Op::ImageSampleExplicitLod) > 0,
            payload: payload(module),
        }
    }
}

fn instructions(module: &Module) -> impl Iterator<Item = &Instruction> {
    module.functions.iter().flat_map(|f| f.all_inst_iter())
}

fn payload(module: &Module) -> usize {
    let globals = module.types_global_values.iter();
    let payloads = globals.filter(|i| {
        let class = i.operands.first();
        i.class.opcode == Op::Variable
            && [StorageClass::RayPayloadKHR, StorageClass::IncomingRayPayloadKHR]
                .iter()
                .any(|&payload| class == Some(&Operand::StorageClass(payload)))
    });
    payloads.filter_map(|i| Some(bytes(module, i.result_type?))).max().unwrap_or(0)
}

/// The bytes of a type, a scalar taken for 4.
fn bytes(module: &Module, id: u32) -> usize {
    let mut globals = module.types_global_values.iter();
    let Some(ty) = globals.find(|i| i.result_id == Some(id)) else { return 0 };
    let part = |at: usize| match ty.operands.get(at) {
        Some(Operand::IdRef(id)) => bytes(module, *id),
        _ => 0,
    };
    let number = |at: usize| match ty.operands.get(at) {
        Some(Operand::LiteralBit32(number)) => *number as usize,
        _ => 0,
    };
    match ty.class.opcode {
        Op::TypePointer => part(1),
        Op::TypeVector | Op::TypeMatrix => part(0) * number(1),
        Op::TypeStruct => (0..ty.operands.len()).map(part).sum(),
        _ => 4,
    }
}
