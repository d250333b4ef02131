//! The structures and descriptors of a compiled shader, and their comparison with Rust.

mod memory;
mod rays;

use std::collections::BTreeSet;

use anyhow::{Context, Result, bail, ensure};
use rspirv::dr::{Module, Operand};
use rspirv::spirv::{Decoration, ImageFormat, Op, StorageClass};

use crate::gpu::pipeline::desc::Binding;
use crate::gpu::pipeline::layout::{Scalar, StructLayout};
pub use rays::{Passed, Payloads};

/// A descriptor as a shader declares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bound {
    /// The set.
    pub set: u32,
    /// The binding.
    pub binding: u32,
    /// The kind of resource, in words.
    pub kind: &'static str,
}

/// A member of a structure as a shader declares it.
pub struct Member {
    /// Its name.
    pub name: String,
    /// Its offset in bytes.
    pub offset: usize,
    /// The numbers it is made of; `None` for addresses, structures and numbers of other sizes.
    pub scalar: Option<Scalar>,
}

/// The structures declared in a shader module.
pub struct Reflection {
    /// The module itself.
    pub module: Module,
}

impl Reflection {
    /// Reads a module.
    ///
    /// # Errors
    /// If the words are not SPIR-V.
    pub fn of(spirv: &[u32]) -> Result<Self> {
        let module = rspirv::dr::load_words(spirv).ok().context("not a SPIR-V module")?;
        Ok(Self { module })
    }

    /// Every structure that has offsets: its name and its members.
    pub fn structs(&self) -> Vec<(String, Vec<Member>)> {
        let structs =
            self.module.types_global_values.iter().filter(|i| i.class.opcode == Op::TypeStruct);
        let mut found = Vec::new();
        for (id, types) in structs.filter_map(|i| Some((i.result_id?, &i.operands))) {
            let members = (0..).zip(types).map(|(number, of)| {
                let name = self.debug_name(id, Some(number));
                let Operand::IdRef(of) = of else { return None };
                Some(Member { name, offset: self.offset(id, number)?, scalar: self.scalar(*of) })
            });
            let members: Option<Vec<_>> = members.collect();
            found.extend(members.map(|members| (self.debug_name(id, None), members)));
        }
        found
    }

    /// The 32-bit numbers that a scalar, a vector, a matrix or an array is made of.
    fn scalar(&self, mut id: u32) -> Option<Scalar> {
        let types = &self.module.types_global_values;
        // A type comes after those that it is made of, so this ends.
        loop {
            let of = types.iter().find(|i| i.result_id == Some(id))?;
            match (of.class.opcode, &of.operands[..]) {
                (Op::TypeFloat, [Operand::LiteralBit32(32), ..]) => return Some(Scalar::Float),
                (Op::TypeInt, [Operand::LiteralBit32(32), Operand::LiteralBit32(0)]) => {
                    return Some(Scalar::Uint);
                }
                (Op::TypeInt, [Operand::LiteralBit32(32), _]) => return Some(Scalar::Int),
                (
                    Op::TypeVector | Op::TypeMatrix | Op::TypeArray,
                    &[Operand::IdRef(element), ..],
                ) if element < id => id = element,
                _ => return None,
            }
        }
    }

    /// Compares every structure with the one of the same name in `known`, if there is one.
    ///
    /// # Errors
    /// On the first field that differs; names structure, field and both offsets, or both types.
    pub fn check(&self, path: &str, known: &[StructLayout]) -> Result<()> {
        for (name, members) in self.structs() {
            let Some(layout) = known.iter().find(|layout| layout.name == name) else { continue };
            for Member { name: member, offset, scalar } in &members {
                match layout.fields.iter().find(|(field, ..)| field == member) {
                    Some((_, expected, _)) if expected != offset => bail!(
                        "{path}: {name}.{member} is {offset} bytes from the start in the shader, \
                         {expected} in Rust; the fields and their order must be the same"
                    ),
                    Some((.., Some(expected))) if scalar.is_some_and(|of| of != *expected) => {
                        bail!(
                            "{path}: {name}.{member} is made of {} in the shader, and of {} in Rust; both must be the \
                         same type",
                            scalar.map_or("other numbers", Scalar::in_glsl),
                            expected.in_rust()
                        )
                    }
                    Some(_) => {}
                    None => bail!("{path}: {name}.{member} is in the shader but not in Rust"),
                }
            }
            // In an array, the second element has another offset if the sizes differ.
            if let Some(stride) = self.stride(&name).filter(|stride| *stride != layout.size) {
                bail!("{path}: {name} takes {stride} bytes in the shader, {} in Rust", layout.size);
            }
            if members.len() < layout.fields.len() {
                let missing = layout
                    .fields
                    .iter()
                    .map(|(field, ..)| *field)
                    .filter(|field| !members.iter().any(|member| member.name == *field));
                let missing: Vec<_> = missing.collect();
                bail!("{path}: {name} lacks {}, which Rust has", missing.join(", "));
            }
        }
        Ok(())
    }

    /// Checks that `known` has every structure that the module reads through an address.
    ///
    /// # Errors
    /// On the first missing one; names it and the line to add.
    pub fn check_addresses(&self, path: &str, known: &[StructLayout]) -> Result<()> {
        let pointees =
            self.module.types_global_values.iter().filter_map(|i| match i.operands[..] {
                [
                    Operand::StorageClass(StorageClass::PhysicalStorageBuffer),
                    Operand::IdRef(pointee),
                ] if i.class.opcode == Op::TypePointer => Some(pointee),
                _ => None,
            });
        let mut seen = BTreeSet::new();
        for pointee in pointees {
            for name in self.structs_within(pointee, &mut seen) {
                ensure!(
                    known.iter().any(|layout| layout.name == name),
                    "{path}: the shader reads a {name} through an address, and Rust says nothing of it; \
                     declare it with shader_struct! {{ struct {name} {{ ... }} }}, and the address as \
                     Address<{name}>"
                );
            }
        }
        Ok(())
    }

    /// The names of the structures that a type is made of, without those that were seen before. A block that
    /// is nothing but a row of elements has no counterpart in Rust.
    fn structs_within(&self, id: u32, seen: &mut BTreeSet<u32>) -> Vec<String> {
        if !seen.insert(id) {
            return Vec::new();
        }
        let types = &self.module.types_global_values;
        let Some(of) = types.iter().find(|i| i.result_id == Some(id)) else { return Vec::new() };
        let members = of.operands.iter().filter_map(|operand| match operand {
            Operand::IdRef(member) => Some(*member),
            _ => None,
        });
        match of.class.opcode {
            Op::TypeArray | Op::TypeRuntimeArray => {
                members.take(1).flat_map(|element| self.structs_within(element, seen)).collect()
            }
            Op::TypeStruct => {
                let is_row = |member: &u32| {
                    let row = |i: &&rspirv::dr::Instruction| i.class.opcode == Op::TypeRuntimeArray;
                    types.iter().filter(row).any(|i| i.result_id == Some(*member))
                };
                let members: Vec<_> = members.collect();
                let own = (!matches!(&members[..], [only] if is_row(only)))
                    .then(|| self.debug_name(id, None));
                own.into_iter()
                    .chain(members.into_iter().flat_map(|member| self.structs_within(member, seen)))
                    .collect()
            }
            _ => Vec::new(),
        }
    }

    /// Checks that the program binds the descriptors that the module declares: `count` bindings in set 0, and the
    /// texture table in set 1, if there is one.
    ///
    /// # Errors
    /// On a descriptor anywhere else, which makes drivers crash.
    pub fn check_bindings(&self, path: &str, bound: &[Binding], has_textures: bool) -> Result<()> {
        for Bound { set, binding, kind } in self.descriptors() {
            let is_bound = match set {
                0 => (binding as usize) < bound.len(),
                1 => has_textures && binding == 0,
                _ => false,
            };
            ensure!(
                is_bound,
                "{path}: set {set}, binding {binding} is {kind}, where the program binds nothing"
            );
            let other =
                bound.get(binding as usize).filter(|other| set == 0 && other.kind() != kind);
            if let Some(other) = other {
                bail!(
                    "{path}: set {set}, binding {binding} is {kind}, where the program binds {}; bindings are \
                     counted from 0 in the order of the .binding lines",
                    other.kind()
                );
            }
        }
        Ok(())
    }

    /// Every descriptor that the module declares, by set and binding.
    pub fn descriptors(&self) -> Vec<Bound> {
        let globals = &self.module.types_global_values;
        let by_id = |id: u32| globals.iter().find(|i| i.result_id == Some(id));
        let variables = globals.iter().filter(|i| i.class.opcode == Op::Variable);
        let mut found: Vec<_> = variables
            .filter_map(|variable| {
                let id = variable.result_id?;
                let pointer = by_id(variable.result_type?)?;
                let Some(Operand::IdRef(pointee)) = pointer.operands.get(1) else { return None };
                Some(Bound {
                    set: self.decoration(id, Decoration::DescriptorSet)?,
                    binding: self.decoration(id, Decoration::Binding)?,
                    kind: match by_id(*pointee)?.class.opcode {
                        Op::TypeAccelerationStructureKHR => "an acceleration structure",
                        Op::TypeImage => "an image",
                        Op::TypeSampledImage => "a texture",
                        Op::TypeArray | Op::TypeRuntimeArray => "an array",
                        _ => "a buffer",
                    },
                })
            })
            .collect();
        found.sort();
        found
    }

    /// The binding and the format of each image in set 0.
    pub fn image_formats(&self) -> Vec<(u32, ImageFormat)> {
        let globals = &self.module.types_global_values;
        let by_id = |id: u32| globals.iter().find(|i| i.result_id == Some(id));
        let variables = globals.iter().filter(|i| i.class.opcode == Op::Variable);
        let formats = variables.filter_map(|variable| {
            let id = variable.result_id?;
            self.decoration(id, Decoration::DescriptorSet).filter(|set| *set == 0)?;
            let pointer = by_id(variable.result_type?)?;
            let Some(Operand::IdRef(pointee)) = pointer.operands.get(1) else { return None };
            let image = by_id(*pointee).filter(|i| i.class.opcode == Op::TypeImage)?;
            let format = image.operands.iter().find_map(|operand| match operand {
                Operand::ImageFormat(format) => Some(*format),
                _ => None,
            });
            Some((self.decoration(id, Decoration::Binding)?, format?))
        });
        formats.collect()
    }

    fn debug_name(&self, id: u32, member: Option<u32>) -> String {
        let names = self.module.debug_names.iter();
        let found = names.filter_map(|i| match (member, i.class.opcode, i.operands.as_slice()) {
            (None, Op::Name, [Operand::IdRef(of), Operand::LiteralString(name)]) => {
                (*of == id).then_some(name)
            }
            (
                Some(member),
                Op::MemberName,
                [Operand::IdRef(of), Operand::LiteralBit32(n), Operand::LiteralString(name)],
            ) => (*of == id && *n == member).then_some(name),
            _ => None,
        });
        found.map(String::as_str).next().unwrap_or_default().to_owned()
    }

    fn offset(&self, id: u32, member: u32) -> Option<usize> {
        self.module.annotations.iter().find_map(|i| match i.operands.as_slice() {
            [
                Operand::IdRef(of),
                Operand::LiteralBit32(n),
                Operand::Decoration(Decoration::Offset),
                Operand::LiteralBit32(offset),
            ] if *of == id && *n == member => Some(*offset as usize),
            _ => None,
        })
    }

    /// The bytes from one element to the next in an array of the structure `name`, if there is one.
    fn stride(&self, name: &str) -> Option<usize> {
        let arrays = self.module.types_global_values.iter();
        let mut arrays = arrays.filter(|i| {
            let is_array = matches!(i.class.opcode, Op::TypeArray | Op::TypeRuntimeArray);
            is_array
                && matches!(i.operands[..], [Operand::IdRef(of), ..] if self.debug_name(of, None) == name)
        });
        let array = arrays.next()?.result_id?;
        self.decoration(array, Decoration::ArrayStride).map(|stride| stride as usize)
    }

    fn decoration(&self, id: u32, wanted: Decoration) -> Option<u32> {
        self.module.annotations.iter().find_map(|i| match i.operands.as_slice() {
            [Operand::IdRef(of), Operand::Decoration(decoration), Operand::LiteralBit32(value)]
                if *of == id && *decoration == wanted =>
            {
                Some(*value)
            }
            _ => None,
        })
    }
}
