//! Functions and types in glslang's notation: `worst_add(vf3;vf3;u1;` has two vectors of three floats and an
//! unsigned integer as parameters.

use std::collections::HashMap;

use anyhow::{Context, Result};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Op, Word};

/// `worst_add(vf3;vf3;u1;` as a call in GLSL.
pub fn glsl_call(signature: &str) -> Result<String> {
    let (name, types) = signature.split_once('(').context("no parameters")?;
    let arguments = types.split_terminator(';').map(|of| {
        let (kind, size) = of.split_at(of.len() - if of.starts_with('m') { 2 } else { 1 });
        let letter = kind.chars().last().context("no type")?;
        let scalar = ["float", "double", "int", "uint", "bool"];
        let scalar = scalar.iter().find(|name| name.starts_with(letter)).context("no such type")?;
        let prefix = if letter == 'f' { "" } else { &scalar[..1] };
        Ok(match kind.chars().next() {
            Some('v') => format!("{prefix}vec{size}(0)"),
            Some('m') => format!("{prefix}mat{}x{}(0)", &size[..1], &size[1..]),
            _ => format!("{scalar}(0)"),
        })
    });
    Ok(format!("{name}({});", arguments.collect::<Result<Vec<_>>>()?.join(", ")))
}

/// A type in glslang's notation for function names; `None` for types that no operation uses.
pub fn type_name(of: &Instruction, names: &HashMap<Word, String>) -> Option<String> {
    Some(match (of.class.opcode, &of.operands[..]) {
        (Op::TypeBool, _) => "b1".to_owned(),
        (Op::TypeFloat, [Operand::LiteralBit32(32), ..]) => "f1".to_owned(),
        (Op::TypeFloat, [Operand::LiteralBit32(64), ..]) => "d1".to_owned(),
        (Op::TypeInt, [Operand::LiteralBit32(32), Operand::LiteralBit32(0)]) => "u1".to_owned(),
        (Op::TypeInt, [Operand::LiteralBit32(32), _]) => "i1".to_owned(),
        (Op::TypeVector, [Operand::IdRef(of), Operand::LiteralBit32(count)]) => {
            format!("v{}{count}", names.get(of)?.trim_end_matches('1'))
        }
        (Op::TypeMatrix, [Operand::IdRef(column), Operand::LiteralBit32(columns)]) => {
            // vf3 of 4 columns: mf43.
            let column = names.get(column)?.strip_prefix('v')?;
            let (of, rows) = column.split_at(1);
            format!("m{of}{columns}{rows}")
        }
        _ => return None,
    })
}
