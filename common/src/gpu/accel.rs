//! Acceleration structures: bottom levels of triangles or boxes, top levels of instances.
//!
//! A build needs three sizes from the driver (structure, build scratch, update scratch), a buffer for
//! the structure and one for the scratch; structures that are built together share both. Compaction copies
//! a structure into a buffer of the size that it turned out to need; an update moves primitives without
//! changing which there are.

mod build;
mod compaction;
pub mod geometry;
pub mod margin;
mod micromap;
pub mod micromap_extension;
pub mod order;
mod place;
mod plan;
mod update;

use std::sync::Arc;

use anyhow::Result;
use ash::vk;

use super::pipeline::Asked;
use super::{Buffer, Gpu};
use crate::gpu::accel::geometry::Geometry;
use crate::gpu::accel::micromap_extension::TrianglesMicromap;
pub use micromap::OpacityMicromap;
use plan::Plan;

/// What a structure is built from: the name that messages call it, and its geometries.
pub type Input<'a> = (&'a str, &'a [Geometry]);

/// What a build may cost and allow later.
#[derive(Clone, Copy, Default)]
pub struct BuildOptions {
    /// Allow [`AccelerationStructure::update`], which a driver may pay for with memory and with a tree that is
    /// slower to trace.
    pub updatable: bool,
    /// Copy the result into a buffer of just the size it needs.
    pub compact: bool,
    /// Let hit shaders ask for the corners of its triangles; needs `VK_KHR_ray_tracing_position_fetch`.
    pub data_access: bool,
    /// The micromap of its only geometry, triangles: [`OpacityMicromap::by_indices`].
    pub micromap: Option<TrianglesMicromap>,
}

/// A `VkAccelerationStructureKHR` of either level with its share of a buffer, freed on drop.
pub struct AccelerationStructure {
    /// The Vulkan handle.
    pub handle: vk::AccelerationStructureKHR,
    /// What an instance names a bottom level by.
    pub address: vk::DeviceAddress,
    /// Bytes that it takes of a buffer.
    pub size: u64,
    /// The hit records that its instances ask for, as far as is known.
    pub asked: Asked,
    /// What it was built from and with.
    plan: Plan,
    /// Where it lies, others that were built with it beside it.
    _buffer: Arc<Buffer>,
    gpu: Gpu,
}

impl AccelerationStructure {
    /// Builds a bottom level from geometries, whose order is their `gl_GeometryIndexEXT`.
    ///
    /// # Errors
    /// If there are more primitives than the device allows, or memory is short.
    pub fn bottom(
        gpu: &Gpu,
        name: &str,
        input: &[Geometry],
        options: BuildOptions,
    ) -> Result<Self> {
        Ok(Self::build(gpu, &[(name, input)], options)?.remove(0))
    }

    /// Bytes that a build in its place needs beside it.
    pub fn build_scratch(&self) -> u64 {
        self.plan.sizes.build_scratch_size
    }

    /// Bytes that an update needs beside it.
    pub fn update_scratch(&self) -> u64 {
        self.plan.sizes.update_scratch_size
    }

    /// Builds a top level from a buffer of `count` `VkAccelerationStructureInstanceKHR`.
    ///
    /// The bottom levels that the instances name must stay alive as long as it is traced.
    ///
    /// # Errors
    /// As [`AccelerationStructure::bottom`].
    pub fn top(
        gpu: &Gpu,
        name: &str,
        instances: &Buffer,
        count: u32,
        options: BuildOptions,
    ) -> Result<Self> {
        let input = [Geometry::Instances { instances: instances.address, count }];
        Ok(Self::build(gpu, &[(name, &input)], options)?.remove(0))
    }
}

impl Drop for AccelerationStructure {
    fn drop(&mut self) {
        self.gpu.forget_level(self.address);
        // SAFETY: submissions are waited for, so no trace or build uses it any more.
        unsafe {
            self.gpu.acceleration_structure.destroy_acceleration_structure(self.handle, None);
        }
        self.gpu.count(|statistics| statistics.acceleration_structure_bytes -= self.size);
    }
}
