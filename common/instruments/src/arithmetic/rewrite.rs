//! Replaces every operation of a module by a call of the corresponding function of worst.glsl.
//!
//! glslang compiles those functions together with the shader, so no linking is needed: an instruction keeps its
//! result's id and turns into `OpFunctionCall`. The types of its operands select the overload, by the names that
//! glslang gives functions: `worst_add(vf3;vf3;u1;`. Because glslang removes unused functions, a first pass over
//! the module collects the functions it will need.

use std::collections::{BTreeSet, HashMap, HashSet};

use anyhow::{Context, Result, bail};
use rspirv::binary::Assemble;
use rspirv::dr::{Function, Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, ExecutionMode, ExecutionModel, Op, StorageClass, Word};

use super::operations::{ids, operation};
use super::signature::{glsl_call, type_name};

/// Prefix of worst.glsl's functions.
const PREFIX: &str = "worst_";

/// Properties of a module that worst.glsl depends on.
pub struct Needs {
    /// The functions it will call, each as a call in GLSL.
    pub calls: Vec<String>,
    /// Declarations of its entry point: a macro, and true if it is declared.
    pub declared: [(&'static str, bool); 3],
    /// True if it receives the device's own triangle hits.
    pub meets_triangles: bool,
}

/// Examines a module before it is compiled with worst.glsl.
///
/// # Errors
/// As [`worst`].
pub fn needs(words: &[u32]) -> Result<Needs> {
    let mut module = rspirv::dr::load_words(words).ok().context("not a SPIR-V module")?;
    let declared = [
        ("WORST_NEAREST", declares(&module, ExecutionMode::RoundingModeRTE)),
        ("WORST_PRESERVES", declares(&module, ExecutionMode::SignedZeroInfNanPreserve)),
        ("WORST_DENORMALS", declares(&module, ExecutionMode::DenormPreserve)),
    ];
    let meets_triangles = meets_triangles(&module);
    let mut rewriter = Rewriter::new(&module, None)?;
    for function in &mut module.functions {
        rewriter.function(function)?;
    }
    let calls =
        rewriter.needed.iter().map(|signature| glsl_call(signature)).collect::<Result<_>>()?;
    Ok(Needs { calls, declared, meets_triangles })
}

/// Rewrites a module. With a `seed`, the errors also depend on the position of an operation.
///
/// # Errors
/// If the words are not SPIR-V, or an operation is missing in worst.glsl.
pub fn worst(words: &[u32], seed: Option<u32>) -> Result<Vec<u32>> {
    let mut module = rspirv::dr::load_words(words).ok().context("not a SPIR-V module")?;
    let mut rewriter = Rewriter::new(&module, seed)?;
    for function in &mut module.functions {
        let id = function.def.as_ref().and_then(|def| def.result_id);
        if !rewriter.own.values().any(|own| Some(*own) == id) {
            rewriter.function(function)?;
        }
    }
    if let Some(missing) = rewriter.needed.iter().find(|name| !rewriter.own.contains_key(*name)) {
        bail!("worst.glsl has no {missing}");
    }
    rewriter.finish(&mut module);
    Ok(module.assemble())
}

/// State of a module while it is rewritten.
struct Rewriter {
    /// The functions of worst.glsl, by name and parameters.
    own: HashMap<String, Word>,
    /// The called functions, or those that may be called.
    needed: BTreeSet<String>,
    /// The types of ids.
    types: HashMap<Word, Word>,
    /// A type in glslang's notation.
    names: HashMap<Word, String>,
    /// The instructions that must not be rearranged.
    precise: HashSet<Word>,
    /// The variables with a hit's distance, and the barycentrics of a triangle.
    distances: HashSet<Word>,
    weights: HashSet<Word>,
    /// RoundingModeRTE and DenormPreserve.
    is_nearest: bool,
    declares_denormals: bool,
    splats: HashMap<(Word, u32), Word>,
    uint: Word,
    how: HashMap<u32, Word>,
    constants: Vec<Instruction>,
    replaced: HashSet<Word>,
    seed: Option<u32>,
    place: u32,
    bound: Word,
}

impl Rewriter {
    fn new(module: &Module, seed: Option<u32>) -> Result<Self> {
        let mut own = HashMap::new();
        for name in &module.debug_names {
            if let (Op::Name, [Operand::IdRef(id), Operand::LiteralString(text)]) =
                (name.class.opcode, &name.operands[..])
                && text.starts_with(PREFIX)
            {
                own.insert(text.clone(), *id);
            }
        }
        let mut names = HashMap::new();
        for instruction in &module.types_global_values {
            if let (Some(id), Some(name)) = (instruction.result_id, type_name(instruction, &names))
            {
                names.insert(id, name);
            }
        }
        // A module without operations may have no number types either.
        let uint = names.iter().find(|(_, name)| *name == "u1").map_or(0, |(id, _)| *id);
        let decorated = |wanted: Decoration, builtin: Option<BuiltIn>| -> HashSet<Word> {
            let found = module.annotations.iter().filter_map(|i| match i.operands[..] {
                [Operand::IdRef(id), Operand::Decoration(decoration), ref rest @ ..] => {
                    let of = builtin.is_none_or(|b| *rest == [Operand::BuiltIn(b)]);
                    (decoration == wanted && of).then_some(id)
                }
                _ => None,
            });
            found.collect()
        };
        let all = module.all_inst_iter();
        let types = all.filter_map(|i| Some((i.result_id?, i.result_type?))).collect();
        let pointees: HashMap<Word, &String> = module
            .types_global_values
            .iter()
            .filter(|i| i.class.opcode == Op::TypePointer)
            .filter_map(|i| Some((i.result_id?, names.get(ids(&i.operands).first()?)?)))
            .collect();
        // The attributes of a procedural hit are not barycentrics.
        let attributes = module.types_global_values.iter().filter(|i| {
            let of = i.result_type.and_then(|of| pointees.get(&of));
            i.class.opcode == Op::Variable
                && i.operands.first() == Some(&Operand::StorageClass(StorageClass::HitAttributeKHR))
                && of.is_some_and(|name| *name == "vf2")
        });
        let weights = attributes.filter_map(|i| i.result_id).collect();
        let meets_triangles = meets_triangles(module);
        Ok(Self {
            own,
            needed: BTreeSet::new(),
            types,
            names,
            precise: decorated(Decoration::NoContraction, None),
            distances: decorated(Decoration::BuiltIn, Some(BuiltIn::RayTmaxKHR))
                .into_iter()
                .filter(|_| meets_triangles)
                .collect(),
            weights: if meets_triangles { weights } else { HashSet::new() },
            is_nearest: declares(module, ExecutionMode::RoundingModeRTE),
            declares_denormals: declares(module, ExecutionMode::DenormPreserve),
            splats: HashMap::new(),
            uint,
            how: HashMap::new(),
            constants: Vec::new(),
            replaced: HashSet::new(),
            seed,
            place: 0,
            bound: module.header.as_ref().context("no header")?.bound,
        })
    }

    fn function(&mut self, function: &mut Function) -> Result<()> {
        let known: HashMap<Word, Instruction> = function
            .all_inst_iter()
            .filter_map(|instruction| Some((instruction.result_id?, instruction.clone())))
            .collect();
        for block in &mut function.blocks {
            let mut instructions = Vec::new();
            for instruction in std::mem::take(&mut block.instructions) {
                self.instruction(instruction, &known, &mut instructions)?;
            }
            block.instructions = instructions;
        }
        Ok(())
    }

    fn instruction(
        &mut self,
        instruction: Instruction,
        known: &HashMap<Word, Instruction>,
        out: &mut Vec<Instruction>,
    ) -> Result<()> {
        let op = instruction.class.opcode;
        if op == Op::Load || op == Op::AccessChain {
            return self.load(instruction, out);
        }
        // For a query of boxes, the shader would have to determine which of the two it hit.
        match op {
            Op::RayQueryGetIntersectionTKHR => {
                return self.moved(instruction, "worst_query_t", out);
            }
            Op::RayQueryGetIntersectionBarycentricsKHR => {
                return self.moved(instruction, "worst_query_weights", out);
            }
            Op::RayQueryGenerateIntersectionKHR => bail!("worst.glsl has no queries of boxes"),
            _ => {}
        }
        let result = instruction.result_type.and_then(|of| self.names.get(&of));
        let widens = op == Op::FConvert && result.is_some_and(|name| name.contains('d'));
        let Some((name, operands)) = operation(&instruction)?.filter(|_| !widens) else {
            out.push(instruction);
            return Ok(());
        };
        if self.is_nearest && self.is_flushed_only(&instruction) {
            return self.flushed(instruction, out);
        }
        if self.is_nearest && name == "worst_fma" {
            let (of, product) = (instruction.result_type, self.fresh());
            let [a, b, c] = operands[..] else { bail!("fma() of three") };
            let two = |a, b| vec![Operand::IdRef(a), Operand::IdRef(b)];
            self.flushed(Instruction::new(Op::FMul, of, Some(product), two(a, b)), out)?;
            let sum = Instruction::new(Op::FAdd, of, instruction.result_id, two(product, c));
            return self.flushed(sum, out);
        }
        let mut call = self.call(&instruction, name, &operands)?;
        if let Some((name, operands)) = self.rearranged(&instruction, known, out) {
            call = self.call(&instruction, name, &operands)?;
        }
        out.push(call);
        Ok(())
    }

    /// The rearranged form of a sum together with a sum or a product among its terms; none where NoContraction
    /// forbids changing either.
    fn rearranged(
        &mut self,
        sum: &Instruction,
        known: &HashMap<Word, Instruction>,
        out: &mut Vec<Instruction>,
    ) -> Option<(&'static str, Vec<Word>)> {
        let is_free = |i: &Instruction| i.result_id.is_some_and(|id| !self.precise.contains(&id));
        let is_difference = sum.class.opcode == Op::FSub;
        if !is_free(sum) || !(is_difference || sum.class.opcode == Op::FAdd) {
            return None;
        }
        let operands = ids(&sum.operands);
        for (inner, outer) in [(0, 1), (1, 0)] {
            let Some(term) = known.get(&operands[inner]).filter(|term| is_free(term)) else {
                continue;
            };
            let mut parts = ids(&term.operands);
            let name = match term.class.opcode {
                Op::FMul | Op::VectorTimesScalar => "worst_contracted",
                Op::FAdd | Op::FSub => "worst_sum",
                _ => continue,
            };
            parts.push(operands[outer]);
            let mut negative = [false, term.class.opcode == Op::FSub, false];
            if is_difference && inner == 0 {
                negative[2] = true;
            } else if is_difference {
                negative[0] = true;
                negative[1] = name == "worst_sum" && !negative[1];
            }
            for (part, is_negative) in parts.iter_mut().zip(negative) {
                if is_negative {
                    *part = self.negated(*part, out);
                }
            }
            return Some((name, parts));
        }
        None
    }

    /// True if an operation rounds to the nearest float anyway, because RoundingModeRTE is declared.
    fn is_flushed_only(&self, instruction: &Instruction) -> bool {
        let op = instruction.class.opcode;
        let of = instruction.result_type.and_then(|of| self.names.get(&of));
        let is_single = of.is_some_and(|name| matches!(&name[..], "f1" | "vf2" | "vf3" | "vf4"));
        is_single && matches!(op, Op::FAdd | Op::FSub | Op::FMul)
    }

    /// The operation itself, and zero if its result is denormalized: a two-float has hundreds of operations, and a
    /// call for each would take the driver's compiler a minute.
    fn flushed(&mut self, mut exact: Instruction, out: &mut Vec<Instruction>) -> Result<()> {
        let (of, result) = (exact.result_type, exact.result_id);
        if self.declares_denormals || self.skips_a_place() {
            out.push(exact);
            return Ok(());
        }
        let name = of.and_then(|of| self.names.get(&of)).context("a float has a type")?;
        let size = name.strip_prefix("vf").and_then(|size| size.parse().ok());
        let like =
            |letter: char| size.map_or(format!("{letter}1"), |n: u32| format!("v{letter}{n}"));
        let (uints, bools) = (self.type_named(&like('u'))?, self.type_named(&like('b'))?);
        let exponent = self.splat(uints, size, 0x7f80_0000)?;
        let sign = self.splat(uints, size, 0x8000_0000)?;
        let none = self.splat(uints, size, 0)?;
        let raw = self.fresh();
        exact.result_id = Some(raw);
        out.push(exact);
        let mut step = |op, of, operands: &[Word], result: Option<Word>| {
            let result = result.unwrap_or_else(|| self.fresh());
            let operands = operands.iter().map(|id| Operand::IdRef(*id)).collect();
            out.push(Instruction::new(op, of, Some(result), operands));
            result
        };
        let bits = step(Op::Bitcast, Some(uints), &[raw], None);
        let scale = step(Op::BitwiseAnd, Some(uints), &[bits, exponent], None);
        let is_small = step(Op::IEqual, Some(bools), &[scale, none], None);
        let zero = step(Op::BitwiseAnd, Some(uints), &[bits, sign], None);
        let flushed = step(Op::Select, Some(uints), &[is_small, zero, bits], None);
        step(Op::Bitcast, of, &[flushed], result);
        self.replaced.extend(result);
        Ok(())
    }

    /// With differences by place, every other position keeps denormalized results.
    fn skips_a_place(&mut self) -> bool {
        self.place += 1;
        self.seed.is_some_and(|seed| (seed ^ self.place.wrapping_mul(0x9e37_79b9)) & 1 == 1)
    }

    /// A type by its name in glslang's notation; it may still be missing in the module.
    fn type_named(&mut self, wanted: &str) -> Result<Word> {
        if let Some((id, _)) = self.names.iter().find(|(_, name)| *name == wanted) {
            return Ok(*id);
        }
        let (op, operands) = match (wanted, wanted.strip_prefix('v')) {
            ("b1", _) => (Op::TypeBool, Vec::new()),
            ("u1", _) => (Op::TypeInt, vec![Operand::LiteralBit32(32), Operand::LiteralBit32(0)]),
            (_, Some(of)) => {
                let size = of[1..].parse().context("a vector's size")?;
                let scalar = self.type_named(&format!("{}1", &of[..1]))?;
                (Op::TypeVector, vec![Operand::IdRef(scalar), Operand::LiteralBit32(size)])
            }
            _ => bail!("no type is named {wanted}"),
        };
        let id = self.fresh();
        self.constants.push(Instruction::new(op, None, Some(id), operands));
        self.names.insert(id, wanted.to_owned());
        Ok(id)
    }

    /// An integer constant, the same in all components of a vector.
    fn splat(&mut self, of: Word, size: Option<u32>, value: u32) -> Result<Word> {
        if let Some(known) = self.splats.get(&(of, value)) {
            return Ok(*known);
        }
        let (op, operands) = match size {
            None => (Op::Constant, vec![Operand::LiteralBit32(value)]),
            Some(size) => {
                let uint = self.type_named("u1")?;
                let one = Operand::IdRef(self.splat(uint, None, value)?);
                (Op::ConstantComposite, vec![one; size as usize])
            }
        };
        let id = self.fresh();
        self.constants.push(Instruction::new(op, Some(of), Some(id), operands));
        self.splats.insert((of, value), id);
        Ok(id)
    }

    fn negated(&mut self, id: Word, out: &mut Vec<Instruction>) -> Word {
        let result = self.fresh();
        let result_type = self.types.get(&id).copied();
        if let Some(result_type) = result_type {
            self.types.insert(result, result_type);
        }
        let operands = vec![Operand::IdRef(id)];
        out.push(Instruction::new(Op::FNegate, result_type, Some(result), operands));
        result
    }

    /// A hit's distance and barycentrics, as inexact as allowed.
    fn load(&mut self, load: Instruction, out: &mut Vec<Instruction>) -> Result<()> {
        let Some(Operand::IdRef(variable)) = load.operands.first().cloned() else {
            bail!("a load of nothing");
        };
        let name = match variable {
            id if self.distances.contains(&id) => "worst_hit_t",
            id if self.weights.contains(&id) => "worst_weights",
            _ => {
                out.push(load);
                return Ok(());
            }
        };
        if load.class.opcode == Op::AccessChain {
            bail!("a component of the weights is read by itself");
        }
        self.moved(load, name, out)
    }

    /// The operands an instruction reads, followed by a call that perturbs the result.
    fn moved(
        &mut self,
        mut read: Instruction,
        name: &str,
        out: &mut Vec<Instruction>,
    ) -> Result<()> {
        let original = read.clone();
        let raw = self.fresh();
        read.result_id = Some(raw);
        self.types.insert(raw, read.result_type.context("what is read has a type")?);
        out.push(read);
        out.push(self.call(&original, name, &[raw])?);
        Ok(())
    }

    /// The call that replaces an instruction, and its result's id.
    fn call(
        &mut self,
        replaced: &Instruction,
        name: &str,
        operands: &[Word],
    ) -> Result<Instruction> {
        let named = |id: &Word| {
            let of = self.types.get(id).and_then(|of| self.names.get(of));
            of.cloned().with_context(|| format!("{name} of an operand without a type"))
        };
        let types: Vec<String> = operands.iter().map(named).collect::<Result<_>>()?;
        let signature = format!("{name}({};u1;", types.join(";"));
        let function = self.own.get(&signature).copied().unwrap_or_default();
        self.needed.insert(signature);
        let how = self.how();
        let arguments = [&[function], operands, &[how]].concat();
        let arguments = arguments.into_iter().map(Operand::IdRef).collect();
        self.replaced.extend(replaced.result_id);
        let (result_type, result) = (replaced.result_type, replaced.result_id);
        Ok(Instruction::new(Op::FunctionCall, result_type, result, arguments))
    }

    /// The constant with the mode of the next operation.
    fn how(&mut self) -> Word {
        let how = match self.seed {
            None => 0,
            Some(seed) => {
                self.place += 1;
                seed ^ self.place.wrapping_mul(0x9e37_79b9)
            }
        };
        if let Some(known) = self.how.get(&how) {
            return *known;
        }
        let id = self.fresh();
        let value = vec![Operand::LiteralBit32(how)];
        self.constants.push(Instruction::new(Op::Constant, Some(self.uint), Some(id), value));
        self.how.insert(how, id);
        id
    }

    fn fresh(&mut self) -> Word {
        self.bound += 1;
        self.bound - 1
    }

    /// Adds the new constants, and removes decorations of instructions that became calls.
    fn finish(self, module: &mut Module) {
        module.types_global_values.extend(self.constants);
        module.annotations.retain(|annotation| match annotation.operands[..] {
            [Operand::IdRef(id), Operand::Decoration(Decoration::NoContraction)] => {
                !self.replaced.contains(&id)
            }
            _ => true,
        });
        if let Some(header) = &mut module.header {
            header.bound = self.bound;
        }
    }
}

/// True if the entry point declares a mode for 32-bit floats.
fn declares(module: &Module, mode: ExecutionMode) -> bool {
    let wanted = [Operand::ExecutionMode(mode), Operand::LiteralBit32(32)];
    module.execution_modes.iter().any(|i| i.operands[1..] == wanted)
}

/// True if the module's stage receives the device's own triangle hits.
fn meets_triangles(module: &Module) -> bool {
    let model = module.entry_points.first().and_then(|entry| entry.operands.first());
    let stages = [ExecutionModel::ClosestHitKHR, ExecutionModel::AnyHitKHR];
    stages.iter().any(|stage| model == Some(&Operand::ExecutionModel(*stage)))
}
