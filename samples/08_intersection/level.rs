//! All shapes of one kind as a bottom level.

use anyhow::Result;
use common::gpu::order::{Bounds, around};
use common::gpu::{AccelerationStructure, Buffer, Gpu};
use common::scene::input_usage;

use super::boxes;

/// A bottom level of shapes, in the order of its build.
pub struct Level {
    /// `None` without shapes.
    pub blas: Option<AccelerationStructure>,
    /// The shape's number for each primitive of the build.
    pub ids: Buffer,
    pub bounds: Bounds,
}

impl Level {
    /// Builds boxes around shapes, first the one that `order` names first. Rays begin at most `reach` from a shape.
    pub fn new(
        gpu: &Gpu,
        name: &str,
        bounds: &[Bounds],
        order: &[u32],
        reach: f32,
    ) -> Result<Self> {
        let ids = Buffer::with_data(gpu, name, order, input_usage())?;
        let ordered = order.iter().map(|&i| bounds[i as usize]);
        let blas =
            (!bounds.is_empty()).then(|| boxes::bottom(gpu, name, ordered, reach)).transpose()?;
        Ok(Self { blas, ids, bounds: around(bounds) })
    }
}
