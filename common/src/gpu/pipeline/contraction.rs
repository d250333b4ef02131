//! SPIR-V modules whose arithmetic the compiler must not rearrange.
//!
//! A compiler may turn `a*b + a*c` into `a*(b + c)`, and where it does so depends on the rest of the program.
//! `precise` in GLSL forbids it for a variable; this forbids it for a module: every arithmetic instruction gets
//! the decoration that `precise` would give it, `NoContraction`.

use anyhow::{Context, Result};
use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, Op};

/// The module with every arithmetic instruction decorated.
///
/// # Errors
/// If the words are not SPIR-V.
pub fn without(words: &[u32]) -> Result<Vec<u32>> {
    let mut module = rspirv::dr::load_words(words).ok().context("not a SPIR-V module")?;
    let decorated = |i: &Instruction| match i.operands[..] {
        [Operand::IdRef(id), Operand::Decoration(Decoration::NoContraction)] => Some(id),
        _ => None,
    };
    let known: Vec<u32> = module.annotations.iter().filter_map(decorated).collect();
    let all = module.functions.iter().flat_map(|function| function.all_inst_iter());
    let arithmetic = all.filter(|i| is_arithmetic(i.class.opcode)).filter_map(|i| i.result_id);
    let new: Vec<_> = arithmetic
        .filter(|id| !known.contains(id))
        .map(|id| {
            let operands = vec![Operand::IdRef(id), Operand::Decoration(Decoration::NoContraction)];
            Instruction::new(Op::Decorate, None, None, operands)
        })
        .collect();
    module.annotations.extend(new);
    Ok(module.assemble())
}

/// True if an instruction computes with floats. Of extended instructions, nearly all do.
fn is_arithmetic(op: Op) -> bool {
    matches!(
        op,
        Op::FAdd
            | Op::FSub
            | Op::FMul
            | Op::FDiv
            | Op::FRem
            | Op::FMod
            | Op::FNegate
            | Op::VectorTimesScalar
            | Op::MatrixTimesScalar
            | Op::VectorTimesMatrix
            | Op::MatrixTimesVector
            | Op::MatrixTimesMatrix
            | Op::Dot
            | Op::ExtInst
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::pipeline::shader;

    #[test]
    fn every_instruction_is_decorated_once_and_nothing_else_changes() {
        let before = shader::compile("41_ray_offset/shade.rchit").unwrap().spirv;
        let after = without(&before).unwrap();
        let load = |words: &[u32]| rspirv::dr::load_words(words).unwrap();
        let (old, new) = (load(&before), load(&after));
        let body = |module: &rspirv::dr::Module| -> Vec<Instruction> {
            module.functions.iter().flat_map(|f| f.all_inst_iter().cloned()).collect()
        };
        assert_eq!(body(&old), body(&new));
        let count = body(&new).iter().filter(|i| is_arithmetic(i.class.opcode)).count();
        let decorations = new
            .annotations
            .iter()
            .filter(|i| i.operands.contains(&Operand::Decoration(Decoration::NoContraction)));
        assert!(count > 50 && decorations.count() >= count, "{count}");
        assert_eq!(without(&after).unwrap(), after, "a second time changes nothing");
    }
}
