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
    let boxes: Vec<[Vec3; 2]> = bounds.into_iter().map(|bounds| padded(bounds, reach)).collect();
    let input = boxes_on_gpu(gpu, name, &boxes)?;
    let count = boxes.len() as u32;
    let geometry = Geometry::Aabbs { boxes: input.address, count, opaque: true };
    let options = BuildOptions { compact: true, ..BuildOptions::default() };
    AccelerationStructure::bottom(gpu, name, &[geometry], options)
}

/// How far a ray may begin from a shape: at the eye or, as shadow rays do, anywhere on the scene.
/// Rounded up to a power of two, so that few steps of a camera change it.
pub fn reach((low, high): Bounds, eye: Vec3) -> f32 {
    let farthest = (eye - low).abs().max((eye - high).abs()).max(high - low);
    farthest.length().log2().ceil().exp2()
}
