//! The ground on the device: one box, next to the pieces on it.

use anyhow::Result;
use common::gpu::{self, AccelerationStructure, Gpu, order};
use common::scene::{Instance, Mesh, Scene, SceneOnGpu, build_top, instance_on_gpu};
use glam::{Affine3A, Vec3};

use super::boxes;
use super::ground::{Ground, Landscape};

/// Greatest drop of the ground under a piece's foot.
const STEEP: f64 = 0.6;

/// The top level.
pub struct Land {
    /// Pieces and ground.
    pub tlas: AccelerationStructure,
    /// The landscape that was built.
    pub landscape: Landscape,
    /// Corners of the ground's box.
    pub bounds: (Vec3, Vec3),
    reach: f32,
    _blas: AccelerationStructure,
}

impl Land {
    /// The ground is one box, whatever its height function is. Its hit group is the second.
    pub fn new(
        gpu: &Gpu,
        source: &Scene,
        scene: &SceneOnGpu,
        landscape: Landscape,
        eye: Vec3,
    ) -> Result<Self> {
        let reach = gpu::reach(landscape.bounds(0.0), eye);
        let bounds = landscape.bounds(gpu::margin(reach));
        let blas = boxes::bottom(gpu, "ground", [bounds], reach)?;

        let mut instances =
            vec![instance_on_gpu(&Affine3A::IDENTITY, source.instances.len(), 1, &blas)];
        let mut boxes = vec![bounds];
        for (index, piece) in source.instances.iter().enumerate() {
            if let Some(piece) = stand(landscape, piece, &source.model.meshes[piece.mesh]) {
                instances.push(instance_on_gpu(
                    &piece.transform,
                    index,
                    0,
                    &scene.blas[piece.mesh],
                ));
                boxes.push(source.instance_bounds(&piece));
            }
        }
        let order = order::for_build(gpu, &boxes, scene.options.ordering).into_iter();
        let tlas = build_top(gpu, &order.map(|i| instances[i as usize]).collect::<Vec<_>>())?;
        Ok(Self { tlas, landscape, bounds, reach, _blas: blas })
    }

    /// The ground that was built, of this material.
    pub fn ground(&self, material: u32) -> Ground {
        let (low, high) = self.bounds;
        // Rays that leave the ground begin in the box.
        let error = self.landscape.error(low.abs().max(high.abs()).as_dvec3());
        let error = (error as f32).next_up();
        Ground { shape: self.landscape.shape(), low, high, error, material }
    }

    /// Tests whether another landscape or another eye needs a rebuild.
    pub fn is_outdated(&self, landscape: Landscape, eye: Vec3) -> bool {
        self.landscape != landscape || self.reach != gpu::reach(landscape.bounds(0.0), eye)
    }
}

/// A piece at the ground's height, by the function that the shaders march: upright, and sunk until no
/// part of its foot hangs in the air. `None` where it is too steep to stand.
pub fn stand(landscape: Landscape, piece: &Instance, mesh: &Mesh) -> Option<Instance> {
    let bottom = mesh.bounds().0.y;
    let foot = mesh.vertices.iter().map(|vertex| vertex.position);
    let foot = foot.filter(|position| position.y == bottom).map(|position| {
        let at = piece.transform.transform_point3(position);
        landscape.height(at.x, at.z)
    });
    let (low, high) = foot.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
    let mut piece = *piece;
    piece.transform.translation.y += low as f32;
    (high - low < STEEP).then_some(piece)
}
