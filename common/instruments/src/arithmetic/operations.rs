//! The mapping from SPIR-V instructions to functions of worst.glsl.

use anyhow::{Context, Result, bail};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{GlslStd450Op, Op, Word};

/// The function for an instruction and its operands; `None` if its result is always exact.
pub fn operation(instruction: &Instruction) -> Result<Option<(&'static str, Vec<Word>)>> {
    let mut operands = ids(&instruction.operands);
    let name = match instruction.class.opcode {
        Op::FAdd => "worst_add",
        Op::FSub => "worst_sub",
        Op::FMul
        | Op::VectorTimesScalar
        | Op::MatrixTimesScalar
        | Op::VectorTimesMatrix
        | Op::MatrixTimesVector
        | Op::MatrixTimesMatrix => "worst_mul",
        Op::FDiv => "worst_div",
        Op::FMod => "worst_mod",
        Op::Dot => "worst_dot",
        Op::IsNan => "worst_isnan",
        Op::IsInf => "worst_isinf",
        Op::FOrdEqual => "worst_equal",
        Op::FUnordNotEqual => "worst_not_equal",
        Op::FOrdLessThan => "worst_less",
        Op::FOrdLessThanEqual => "worst_less_equal",
        Op::FOrdGreaterThan => "worst_greater",
        Op::FOrdGreaterThanEqual => "worst_greater_equal",
        Op::ConvertSToF | Op::ConvertUToF => "worst_convert",
        Op::ExtInst => {
            operands.remove(0);
            match instruction.operands.get(1) {
                Some(Operand::LiteralExtInstInteger(number)) => match extended(*number)? {
                    Some(name) => name,
                    None => return Ok(None),
                },
                _ => bail!("an extended instruction without a number"),
            }
        }
        Op::FConvert => "worst_convert",
        op @ (Op::FRem
        | Op::OuterProduct
        | Op::FOrdNotEqual
        | Op::FUnordEqual
        | Op::FUnordLessThan
        | Op::FUnordLessThanEqual
        | Op::FUnordGreaterThan
        | Op::FUnordGreaterThanEqual
        | Op::QuantizeToF16) => bail!("worst.glsl has no {op:?}"),
        // A change of sign is exact, and so are operations that neither add nor round.
        _ => return Ok(None),
    };
    Ok(Some((name, operands)))
}

/// The function for an instruction of GLSL.std.450.
fn extended(number: u32) -> Result<Option<&'static str>> {
    let op = GlslStd450Op::from_u32(number)
        .with_context(|| format!("no extended instruction {number}"))?;
    Ok(Some(match op {
        GlslStd450Op::Round => "worst_round",
        GlslStd450Op::RoundEven => "worst_round_even",
        GlslStd450Op::Trunc => "worst_trunc",
        GlslStd450Op::FAbs => "worst_abs",
        GlslStd450Op::FSign => "worst_sign",
        GlslStd450Op::Floor => "worst_floor",
        GlslStd450Op::Ceil => "worst_ceil",
        GlslStd450Op::Fract => "worst_fract",
        GlslStd450Op::Sin => "worst_sin",
        GlslStd450Op::Cos => "worst_cos",
        GlslStd450Op::Tan => "worst_tan",
        GlslStd450Op::Asin => "worst_asin",
        GlslStd450Op::Acos => "worst_acos",
        GlslStd450Op::Atan => "worst_atan",
        GlslStd450Op::Atan2 => "worst_atan2",
        GlslStd450Op::Pow => "worst_pow",
        GlslStd450Op::Exp => "worst_exp",
        GlslStd450Op::Log => "worst_log",
        GlslStd450Op::Exp2 => "worst_exp2",
        GlslStd450Op::Log2 => "worst_log2",
        GlslStd450Op::Sqrt => "worst_sqrt",
        GlslStd450Op::InverseSqrt => "worst_inversesqrt",
        GlslStd450Op::FMin => "worst_min",
        GlslStd450Op::FMax => "worst_max",
        GlslStd450Op::FClamp => "worst_clamp",
        GlslStd450Op::FMix => "worst_mix",
        GlslStd450Op::Step => "worst_step",
        GlslStd450Op::SmoothStep => "worst_smoothstep",
        GlslStd450Op::Fma => "worst_fma",
        GlslStd450Op::Length => "worst_length",
        GlslStd450Op::Distance => "worst_distance",
        GlslStd450Op::Cross => "worst_cross",
        GlslStd450Op::Normalize => "worst_normalize",
        GlslStd450Op::FaceForward => "worst_faceforward",
        GlslStd450Op::Reflect => "worst_reflect",
        GlslStd450Op::Refract => "worst_refract",
        // Integer and bit operations.
        GlslStd450Op::SAbs
        | GlslStd450Op::SSign
        | GlslStd450Op::UMin
        | GlslStd450Op::SMin
        | GlslStd450Op::UMax
        | GlslStd450Op::SMax
        | GlslStd450Op::UClamp
        | GlslStd450Op::SClamp
        | GlslStd450Op::PackDouble2x32
        | GlslStd450Op::UnpackDouble2x32
        | GlslStd450Op::FindILsb
        | GlslStd450Op::FindSMsb
        | GlslStd450Op::FindUMsb => return Ok(None),
        other => bail!("worst.glsl has no {other:?}"),
    }))
}

/// The ids among an instruction's operands.
pub fn ids(operands: &[Operand]) -> Vec<Word> {
    let ids = operands.iter().filter_map(|operand| match operand {
        Operand::IdRef(id) => Some(*id),
        _ => None,
    });
    ids.collect()
}
