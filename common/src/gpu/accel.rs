//! Acceleration structures: bottom levels of triangles or boxes, top levels of instances.
//!
//! A build needs three sizes from the driver (structure, build scratch, update scratch), a buffer for the
//! structure and one for the scratch; structures built together share both. Compaction copies a structure into a
//! buffer of the size it turned out to need; an update moves primitives without adding or removing any.

mod build;
mod compaction;
pub mod geometry;
mod input;
mod level;
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
pub use level::Level;
pub use micromap::OpacityMicromap;
use plan::Plan;

/// Input of a build: a name for messages, and the geometries.
pub type Input<'a> = (&'a str, &'a [Geometry]);

/// Options for a build: its cost, and the operations allowed later.
#[derive(Clone, Copy, Default)]
pub struct BuildOptions {
    /// Allow [`AccelerationStructure::update`], for which a driver may use more memory and build a tree that is
    /// slower to trace.
    pub updatable: bool,
    /// Copy the result into a buffer of exactly the size it needs.
    pub compact: bool,
    /// Let hit shaders fetch the corners of its triangles; needs `VK_KHR_ray_tracing_position_fetch`.
    pub data_access: bool,
    /// The micromap of its only geometry, which must be triangles: [`OpacityMicromap::by_indices`].
    pub micromap: Option<TrianglesMicromap>,
}

/// A `VkAccelerationStructureKHR` of either level with its share of a buffer, freed on drop: a bottom level once no
/// top level of [`build_top`](crate::scene::build_top) refers to it.
pub struct AccelerationStructure {
    /// The Vulkan handle.
    pub handle: vk::AccelerationStructureKHR,
    /// The address by which an instance refers to a bottom level.
    pub address: vk::DeviceAddress,
    /// Bytes it occupies in a buffer.
    pub size: u64,
    /// The hit records its instances use, as far as known.
    pub asked: Asked,
    /// The geometries and options it was built with.
    plan: Plan,
    _level: Arc<Level>,
    /// The bottom levels of its instances, as far as known: they live as long as it does.
    below: Vec<Arc<Level>>,
    gpu: Gpu,
}

impl AccelerationStructure {
    /// Builds a bottom level from geometries; their order is their `gl_GeometryIndexEXT`.
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

    /// Bytes the driver reserves for a build: compaction frees those it did not need.
    pub fn built_size(&self) -> u64 {
        self.plan.sizes.acceleration_structure_size
    }

    /// Bytes of scratch for a build in its place.
    pub fn build_scratch(&self) -> u64 {
        self.plan.sizes.build_scratch_size
    }

    /// Bytes of scratch for an update.
    pub fn update_scratch(&self) -> u64 {
        self.plan.sizes.update_scratch_size
    }

    /// Builds a top level from a buffer of `count` `VkAccelerationStructureInstanceKHR`.
    ///
    /// The bottom levels the instances refer to must stay alive as long as it is traced;
    /// [`build_top`](crate::scene::build_top) keeps them alive.
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

impl AccelerationStructure {
    /// Keeps these bottom levels alive as long as this top level.
    pub(crate) fn keep(&mut self, below: Vec<Arc<Level>>) {
        self.below = below;
    }
}
