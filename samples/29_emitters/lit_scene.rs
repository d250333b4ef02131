//! A scene on the device with its emitters: the spheres beside the meshes in one top level, and the list.

use anyhow::Result;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, order, padded};
use common::scene::{
    SceneOnGpu, SceneOptions, boxes_on_gpu, build_top, input_usage, instance_on_gpu,
};
use glam::{Affine3A, Vec3};

use super::emitters::{EmitterAddresses, Emitters};
use super::scenes::Staged;

/// The traced scene, and its emitters.
pub struct LitScene {
    /// Meshes, materials, textures.
    pub on_gpu: SceneOnGpu,
    /// Meshes and spheres.
    pub tlas: AccelerationStructure,
    /// An [`EmitterAddresses`].
    pub emitters: Buffer,
    /// Bound on the distance from a ray's origin to the spheres.
    reach: f32,
    _spheres: Option<AccelerationStructure>,
    _buffers: [Buffer; 4],
}

impl LitScene {
    /// Uploads and builds it, for rays that begin at `eye` or anywhere in the scene.
    ///
    /// # Errors
    /// If memory is short, or an emitter's power is not a number.
    pub fn new(gpu: &Gpu, staged: &Staged, options: SceneOptions, eye: Vec3) -> Result<Self> {
        let on_gpu = SceneOnGpu::new(gpu, &staged.scene, options)?;
        Self::around(gpu, on_gpu, staged, eye)
    }

    /// Another scene with the same textures.
    ///
    /// # Errors
    /// As [`LitScene::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, staged: &Staged, eye: Vec3) -> Result<()> {
        let (options, textures) = (self.on_gpu.options, self.on_gpu.textures.clone());
        let on_gpu = SceneOnGpu::with_textures(gpu, &staged.scene, options, Some(textures))?;
        *self = Self::around(gpu, on_gpu, staged, eye)?;
        Ok(())
    }

    fn around(gpu: &Gpu, on_gpu: SceneOnGpu, staged: &Staged, eye: Vec3) -> Result<Self> {
        let Staged { scene, spheres, .. } = staged;
        let emitters = Emitters::new(scene, spheres)?;
        let reach = reach(staged, eye);

        // 08 teaches the box around a sphere, and 42 its margin.
        let bounds: Vec<order::Bounds> = spheres
            .iter()
            .map(|sphere| {
                let half = Vec3::splat(sphere.radius.next_up());
                (sphere.center - half, sphere.center + half)
            })
            .collect();
        let ids = order::for_build(gpu, &bounds, on_gpu.options.ordering);
        let boxes: Vec<[Vec3; 2]> =
            ids.iter().map(|&i| padded(bounds[i as usize], reach)).collect();
        let input = boxes_on_gpu(gpu, "spheres", &boxes)?;
        let geometry =
            Geometry::Aabbs { boxes: input.address, count: boxes.len() as u32, opaque: true };
        let level = (!spheres.is_empty()).then(|| {
            let options = BuildOptions { compact: true, ..BuildOptions::default() };
            AccelerationStructure::bottom(gpu, "spheres", &[geometry], options)
        });
        let level = level.transpose()?;

        let mut around = scene.bounds_of_instances();
        let placed = scene.instances.iter().enumerate().map(|(i, instance)| {
            instance_on_gpu(&instance.transform, i, 0, &on_gpu.blas[instance.mesh])
        });
        let mut placed: Vec<_> = placed.collect();
        if let Some(level) = &level {
            // One more instance for all spheres; hit group 1 is theirs.
            placed.push(instance_on_gpu(&Affine3A::IDENTITY, scene.instances.len(), 1, level));
            around.push(
                bounds.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), b| {
                    (low.min(b.0), high.max(b.1))
                }),
            );
        }
        let order = order::for_build(gpu, &around, on_gpu.options.ordering);
        let placed: Vec<_> = order.iter().map(|&i| placed[i as usize]).collect();
        let tlas = build_top(gpu, &placed)?;

        let buffers = [
            Buffer::with_data(gpu, "emitters", &emitters.list, input_usage())?,
            Buffer::with_data(gpu, "columns", &emitters.table.columns, input_usage())?,
            Buffer::with_data(gpu, "first emitters", &emitters.first, input_usage())?,
            Buffer::with_data(gpu, "sphere ids", &ids, input_usage())?,
        ];
        let addresses = EmitterAddresses {
            emitters: buffers[0].address.into(),
            columns: buffers[1].address.into(),
            first: buffers[2].address.into(),
            sphere_ids: buffers[3].address.into(),
            count: if emitters.table.columns.is_empty() { 0 } else { emitters.list.len() as u32 },
            column_count: emitters.table.columns.len() as u32,
        };
        Ok(Self {
            emitters: Buffer::with_data(gpu, "emitter addresses", &[addresses], input_usage())?,
            on_gpu,
            tlas,
            reach,
            _spheres: level,
            _buffers: buffers,
        })
    }

    /// Tests whether the eye has gone farther than the boxes around spheres allow for.
    pub fn is_outdated(&self, staged: &Staged, eye: Vec3) -> bool {
        reach(staged, eye) != self.reach
    }
}

/// Bound on the distance from a ray's origin to a sphere, rounded up to a power of two, from 1024 on.
fn reach(staged: &Staged, eye: Vec3) -> f32 {
    let (low, high) = staged.bounds();
    let farthest = (eye - low).abs().max((eye - high).abs()).max(high - low);
    farthest.length().max(1024.0).log2().ceil().exp2()
}
