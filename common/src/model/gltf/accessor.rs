//! Accessors: arrays of numbers in buffers, of any component type, strided, normalised or sparse.

use anyhow::{Context, Result, bail, ensure};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, buffer};

use super::file::{File, missing};

/// The elements of an accessor, one after the other without gaps.
struct Elements {
    bytes: Vec<u8>,
    component: ComponentType,
    normalized: bool,
}

impl File {
    /// The number of elements of an accessor.
    ///
    /// # Errors
    /// If there is no such accessor.
    pub fn count(&self, index: Index<Accessor>) -> Result<u64> {
        Ok(self.accessor(index)?.count.0)
    }

    /// The `count` elements of an accessor, of `N` numbers each; whole ones become fractions if it says so.
    ///
    /// # Errors
    /// If it has another type or count, or reaches beyond its buffer.
    pub fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        count: usize,
    ) -> Result<Vec<[f32; N]>> {
        let elements = self.elements(index, &[N], count)?;
        let numbers = elements.numbers();
        let mut list = Vec::with_capacity(numbers.len() / N);
        list.extend(numbers.chunks_exact(N).map(|numbers| {
            let mut element = [0.0; N];
            element.copy_from_slice(numbers);
            element
        }));
        Ok(list)
    }

    /// The colours of an accessor, with three or four numbers each; alpha is left out.
    ///
    /// # Errors
    /// As [`File::floats`].
    pub fn colors(&self, index: Index<Accessor>, count: usize) -> Result<Vec<[f32; 3]>> {
        let width = width(self.accessor(index)?)?;
        let numbers = self.elements(index, &[3, 4], count)?.numbers();
        Ok(numbers.chunks_exact(width).map(|color| [color[0], color[1], color[2]]).collect())
    }

    /// The whole numbers of an accessor, `N` in each element.
    ///
    /// # Errors
    /// If it has another type, or reaches beyond its buffer.
    pub fn integers<const N: usize>(
        &self,
        index: Index<Accessor>,
        count: usize,
    ) -> Result<Vec<[u32; N]>> {
        let numbers = self.elements(index, &[N], count)?.whole();
        let numbers = numbers.with_context(|| {
            format!("accessor {} holds no unsigned whole numbers", index.value())
        })?;
        let element = |numbers: &[u32]| {
            let mut element = [0; N];
            element.copy_from_slice(numbers);
            element
        };
        Ok(numbers.chunks_exact(N).map(element).collect())
    }

    fn accessor(&self, index: Index<Accessor>) -> Result<&Accessor> {
        self.root.get(index).with_context(|| missing("accessor", index, &self.root.accessors))
    }

    /// The elements of an accessor, whose type must have one of the `widths`. The `count` has been counted: an accessor
    /// of zeros, which takes no bytes of a file, may state any.
    fn elements(&self, index: Index<Accessor>, widths: &[usize], count: usize) -> Result<Elements> {
        let accessor = self.accessor(index)?;
        let number = index.value();
        let width = width(accessor)?;
        ensure!(
            widths.contains(&width),
            "accessor {number} has {width} numbers in each element, where there are {}",
            widths[0]
        );
        let Checked::Valid(component) = accessor.component_type else {
            bail!("accessor {number} has a component type that glTF 2 does not have");
        };
        let component = component.0;
        let size = width * component.size();
        ensure!(
            accessor.count.0 == count as u64,
            "accessor {number} has {} elements, where there are {count}",
            accessor.count.0
        );
        let whole = count.checked_mul(size).context("an accessor has too many elements")?;
        let mut bytes = match accessor.buffer_view {
            // All zero, except for its sparse elements.
            None => vec![0; whole],
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                self.strided(view, offset, size, count)
                    .with_context(|| format!("accessor {number}"))
                    .map_err(|error| anyhow::anyhow!("{error:#}"))?
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(kind) = sparse.indices.component_type else {
                bail!("accessor {number} has sparse indices of an unknown type");
            };
            let changed = usize::try_from(sparse.count.0)?;
            ensure!(changed <= count, "accessor {number} changes {changed} elements of {count}");
            let (indices, values) = (&sparse.indices, &sparse.values);
            let at = indices.byte_offset.0;
            let at = self.strided(indices.buffer_view, at, kind.0.size(), changed)?;
            let values = self.strided(values.buffer_view, values.byte_offset.0, size, changed)?;
            let indices = Elements { bytes: at, component: kind.0, normalized: false };
            let indices = indices.whole().context("sparse indices have a wrong type")?;
            for (index, value) in indices.into_iter().zip(values.chunks_exact(size)) {
                let element = (index as usize).checked_mul(size);
                let place = element.and_then(|start| bytes.get_mut(start..start + size));
                let place = place.with_context(|| {
                    format!("accessor {number} changes element {index}, and has {count}")
                })?;
                place.copy_from_slice(value);
            }
        }
        Ok(Elements { bytes, component, normalized: accessor.normalized })
    }

    /// Elements of a buffer view without the gaps between them.
    fn strided(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        size: usize,
        count: usize,
    ) -> Result<Vec<u8>> {
        let (bytes, described) = self.view(view)?;
        if count == 0 {
            return Ok(Vec::new());
        }
        let stride = described.byte_stride.map_or(size, |stride| stride.0);
        ensure!(
            stride >= size,
            "buffer view {} has the stride {stride}, and an element {size} bytes",
            view.value()
        );
        let end = (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size));
        let range = usize::try_from(offset)
            .ok()
            .zip(end)
            .and_then(|(offset, end)| Some(offset..offset.checked_add(end)?));
        let bytes = range.and_then(|range| bytes.get(range)).with_context(|| {
            format!("reaches beyond the {} bytes of buffer view {}", bytes.len(), view.value())
        })?;
        if stride == size {
            return Ok(bytes.to_vec());
        }
        let mut packed = Vec::with_capacity(count * size);
        for element in bytes.chunks(stride) {
            packed.extend_from_slice(&element[..size.min(element.len())]);
        }
        Ok(packed)
    }
}

impl Elements {
    /// The numbers, in 32 bits.
    fn numbers(&self) -> Vec<f32> {
        let bytes = self.bytes.as_slice();
        let over = |most: f32| if self.normalized { most } else { 1.0 };
        // The lowest of a signed type is a step beyond -1.
        let least = if self.normalized { -1.0 } else { f32::NEG_INFINITY };
        match self.component {
            ComponentType::I8 => {
                let signed = bytes.iter().map(|&byte| f32::from(byte as i8));
                signed.map(|number| (number / over(127.0)).max(least)).collect()
            }
            ComponentType::U8 => bytes.iter().map(|&byte| f32::from(byte) / over(255.0)).collect(),
            ComponentType::I16 => {
                let signed = parts(bytes).map(|number| f32::from(i16::from_le_bytes(number)));
                signed.map(|number| (number / over(32767.0)).max(least)).collect()
            }
            ComponentType::U16 => {
                let numbers = parts(bytes).map(|number| f32::from(u16::from_le_bytes(number)));
                numbers.map(|number| number / over(65535.0)).collect()
            }
            ComponentType::U32 => {
                parts(bytes).map(|number| u32::from_le_bytes(number) as f32).collect()
            }
            ComponentType::F32 => parts(bytes).map(f32::from_le_bytes).collect(),
        }
    }

    /// The numbers, if they are unsigned whole ones.
    fn whole(&self) -> Option<Vec<u32>> {
        let bytes = self.bytes.as_slice();
        Some(match self.component {
            ComponentType::U8 => bytes.iter().map(|&byte| byte.into()).collect(),
            ComponentType::U16 => {
                parts(bytes).map(|number| u16::from_le_bytes(number).into()).collect()
            }
            ComponentType::U32 => parts(bytes).map(u32::from_le_bytes).collect(),
            ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => return None,
        })
    }
}

/// Arrays of `N` bytes, one after the other.
fn parts<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> + '_ {
    bytes.chunks_exact(N).map(|part| {
        let mut array = [0; N];
        array.copy_from_slice(part);
        array
    })
}

/// The numbers of an element.
fn width(accessor: &Accessor) -> Result<usize> {
    let Checked::Valid(kind) = accessor.type_ else {
        bail!("an accessor has a type that glTF 2 does not have");
    };
    Ok(match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    })
}
