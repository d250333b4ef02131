//! Placement of structures one after the other in a buffer.

use std::sync::Arc;

use anyhow::Result;
use ash::vk;

use super::{AccelerationStructure, Level, Plan};
use crate::gpu::memory::buffer::offsets;
use crate::gpu::pipeline::Asked;
use crate::gpu::{Buffer, Geometry, Gpu};

/// Alignment of a structure's offset in its buffer.
pub(super) const OFFSET_ALIGNMENT: u64 = 256;

/// Structures of the given sizes in one new buffer, not built yet.
pub(super) fn place(
    gpu: &Gpu,
    plans: Vec<Plan>,
    sizes: &[u64],
) -> Result<Vec<AccelerationStructure>> {
    let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    let (offsets, room) = offsets(sizes.iter().copied(), OFFSET_ALIGNMENT);
    let name = together(&plans);
    let buffer = Arc::new(Buffer::new(gpu, &name, room, usage)?);
    let mut placed = Vec::with_capacity(plans.len());
    for ((plan, &size), offset) in plans.into_iter().zip(sizes).zip(offsets) {
        let info = vk::AccelerationStructureCreateInfoKHR::default()
            .ty(plan.level())
            .buffer(buffer.handle)
            .offset(offset)
            .size(size);
        let extension = &gpu.acceleration_structure;
        // SAFETY: the buffer has room there and lives as long as the structure.
        let handle = unsafe { extension.create_acceleration_structure(&info, None)? };
        let of =
            vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(handle);
        // SAFETY: the structure is alive.
        let address = unsafe { extension.get_acceleration_structure_device_address(&of) };
        gpu.name_object(handle, &plan.name);
        gpu.count(|statistics| statistics.acceleration_structure_bytes += size);
        let kind = plan.geometries.first().map(Geometry::kind);
        let (geometries, name) = ((kind, plan.geometries.len() as u32), plan.name.clone());
        let (_buffer, gpu) = (buffer.clone(), gpu.clone());
        let _level =
            Arc::new(Level { handle, address, size, name, geometries, _buffer, gpu: gpu.clone() });
        gpu.note_level(&_level);
        let (asked, below) = (Asked::default(), Vec::new());
        placed.push(AccelerationStructure {
            handle,
            address,
            size,
            asked,
            plan,
            _level,
            below,
            gpu,
        });
    }
    Ok(placed)
}

/// A name for structures that share a buffer.
pub(super) fn together(plans: &[Plan]) -> String {
    match plans {
        [one] => one.name.clone(),
        [first, others @ ..] => format!("{} and {} more", first.name, others.len()),
        [] => String::from("nothing"),
    }
}
