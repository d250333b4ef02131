//! A bottom level of boxes around shapes that the device does not know, and their margin.

use anyhow::Result;
use common::gpu::order::Bounds;
use common::gpu::{AccelerationStructure, BuildOptions, Geometry, Gpu, padded};
use common::scene::boxes_on_gpu;
use glam::Vec3;

/// Boxes around shapes, one at least, as a bottom level. Rays begin at most `reach` from a shape.
pub fn bottom(
    gpu: &Gpu,
    name: &str,
    bounds: impl IntoIterator<Item = Bounds>,
    reach: f32,
) -> Result<AccelerationStructure> {
    // ANCHOR: boxes
    let boxes: Vec<[Vec3; 2]> = bounds.into_iter().map(|bounds| padded(bounds, reach)).collect();
    let input = boxes_on_gpu(gpu, name, &boxes)?;
    let count = boxes.len() as u32;
    let geometry = Geometry::Aabbs { boxes: input.address, count, opaque: true };
    // ANCHOR_END: boxes
    let options = BuildOptions { compact: true, ..BuildOptions::default() };
    AccelerationStructure::bottom(gpu, name, &[geometry], options)
}
