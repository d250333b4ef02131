//! The memory of a shader's variables: if no device has as much, drivers crash instead of reporting an error.

use std::collections::HashMap;

use anyhow::{Result, bail, ensure};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Op, StorageClass};

use super::Reflection;

/// The limit for all variables of a shader, in bytes: more than any device has for one invocation.
const VARIABLES: u64 = 1 << 20;
/// The limit for a type, in bytes, also in a buffer: drivers use 32-bit sizes, some of them signed.
const TYPE: u64 = 1 << 30;

impl Reflection {
    /// Checks the size of the module's variables, except those in buffers, against these limits.
    ///
    /// # Errors
    /// If they are larger; states the bytes.
    pub fn check_memory(&self, path: &str) -> Result<()> {
        let Some(sizes) = self.sizes() else {
            bail!(
                "{path}: an array's length is computed from specialization constants; name one alone"
            );
        };
        let pointees = self.module.types_global_values.iter().filter_map(|i| {
            match (i.class.opcode, &i.operands[..]) {
                (Op::TypePointer, [_, Operand::IdRef(pointee)]) => Some((i.result_id?, *pointee)),
                _ => None,
            }
        });
        let pointees: HashMap<u32, u32> = pointees.collect();
        let blocks = self.module.functions.iter().flat_map(|function| &function.blocks);
        let local = blocks.flat_map(|block| &block.instructions);
        let variables = self.module.types_global_values.iter().chain(local);
        let bytes = variables
            .filter(|i| i.class.opcode == Op::Variable && is_own(i))
            .filter_map(|i| sizes.get(pointees.get(&i.result_type?)?))
            .fold(0, |sum: u64, size| sum.saturating_add(*size));
        ensure!(
            bytes <= VARIABLES,
            "{path}: its variables take {bytes} bytes; at most {VARIABLES} are accepted"
        );
        let largest = sizes.values().copied().max().unwrap_or_default();
        ensure!(
            largest <= TYPE,
            "{path}: a type takes {largest} bytes; at most {TYPE} are accepted"
        );
        Ok(())
    }

    /// The bytes of each type; `None` if they depend on a value only the driver computes. An array at the end of a
    /// buffer, without a length, has no elements.
    fn sizes(&self) -> Option<HashMap<u32, u64>> {
        let mut sizes: HashMap<u32, u64> = HashMap::new();
        let mut lengths: HashMap<u32, u64> = HashMap::new();
        // The parts of a type are declared before it.
        for i in &self.module.types_global_values {
            let Some(id) = i.result_id else { continue };
            let of = |operand: &Operand| match operand {
                Operand::IdRef(id) => sizes.get(id).copied().unwrap_or_default(),
                _ => 0,
            };
            let size = match (i.class.opcode, &i.operands[..]) {
                (Op::Constant | Op::SpecConstant, [Operand::LiteralBit32(value)]) => {
                    lengths.insert(id, u64::from(*value));
                    continue;
                }
                (Op::TypeBool, _) => 4,
                (Op::TypeInt | Op::TypeFloat, [Operand::LiteralBit32(bits), ..]) => {
                    u64::from(bits / 8)
                }
                (Op::TypeVector | Op::TypeMatrix, [part, Operand::LiteralBit32(count)]) => {
                    of(part).saturating_mul(u64::from(*count))
                }
                (Op::TypeArray, [element, Operand::IdRef(length)]) => {
                    of(element).saturating_mul(*lengths.get(length)?)
                }
                (Op::TypeStruct, members) => members.iter().map(of).fold(0, u64::saturating_add),
                (Op::TypePointer, _) => 8,
                _ => continue,
            };
            sizes.insert(id, size);
        }
        Some(sizes)
    }
}

/// True if a variable is private to an invocation or a workgroup, rather than in a buffer or a descriptor.
fn is_own(variable: &Instruction) -> bool {
    let elsewhere = [
        StorageClass::Uniform,
        StorageClass::UniformConstant,
        StorageClass::StorageBuffer,
        StorageClass::PhysicalStorageBuffer,
        StorageClass::ShaderRecordBufferKHR,
        StorageClass::PushConstant,
    ];
    match variable.operands.first() {
        Some(Operand::StorageClass(class)) => !elsewhere.contains(class),
        _ => false,
    }
}
