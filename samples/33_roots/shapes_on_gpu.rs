//! The tori on the device: a bottom level of their boxes, beside the meshes.

use anyhow::Result;
use common::gpu::order::{self, around};
use common::gpu::{AccelerationStructure, Address, Buffer, Gpu, reach};
use common::scene::{Scene, SceneOnGpu, build_top, input_usage, instance_on_gpu};
use glam::{Affine3A, Vec3};

use crate::level::Level;
use crate::scenes::{self, SceneKind};
use crate::tori::Torus;

/// Parameters of the tori; a change rebuilds them.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub scene: SceneKind,
    /// The radius of the tube of *ring*.
    pub tube: f32,
}

common::shader_struct! {
    /// Addresses of the tori, and the torus of each primitive of the build.
    pub struct ShapeAddresses {
        pub tori: Address<Torus>,
        pub ids: Address,
    }
}

/// The tori in device memory, and the top level that holds them beside the meshes.
pub struct ShapesOnGpu {
    pub tlas: AccelerationStructure,
    /// The buffer with the addresses of the tori: a [`ShapeAddresses`].
    pub addresses: Buffer,
    /// Corners of the box around everything.
    bounds: order::Bounds,
    /// Bound on the distance from a ray's origin to a torus; the margin of the boxes grows with it.
    reach: f32,
    build: Build,
    _level: Option<AccelerationStructure>,
    _buffers: Vec<Buffer>,
}

impl ShapesOnGpu {
    pub fn new(
        gpu: &Gpu,
        source: &Scene,
        scene: &SceneOnGpu,
        build: Build,
        eye: Vec3,
    ) -> Result<Self> {
        let tori = scenes::tori(build.scene, build.tube, &source.model);
        let boxes: Vec<_> = tori.iter().map(Torus::bounds).collect();
        let has_meshes = build.scene == SceneKind::Chain;
        let pieces: Vec<_> = source.instances.iter().enumerate().filter(|_| has_meshes).collect();
        let mut bounds: Vec<_> =
            pieces.iter().map(|(_, piece)| source.instance_bounds(piece)).collect();
        let everything = around(bounds.iter().chain(&boxes));
        let reach = reach(everything, eye);

        let ordering = scene.options.ordering;
        let mut instances = Vec::new();
        for (index, piece) in pieces {
            let blas = &scene.blas[piece.mesh];
            instances.push(instance_on_gpu(&piece.transform, index, 0, blas));
        }
        // One more instance for all tori. Hit group 0 is that of triangles, 1 of tori.
        let order = order::for_build(gpu, &boxes, ordering);
        let level = Level::new(gpu, "tori", &boxes, &order, reach)?;
        if let Some(blas) = &level.blas {
            let index = source.instances.len();
            instances.push(instance_on_gpu(&Affine3A::IDENTITY, index, 1, blas));
            bounds.push(level.bounds);
        }
        let ordered = order::for_build(gpu, &bounds, ordering);
        let ordered: Vec<_> = ordered.iter().map(|&i| instances[i as usize]).collect();
        let tlas = build_top(gpu, &ordered)?;

        let records = Buffer::with_data(gpu, "tori", &tori, input_usage())?;
        let addresses =
            ShapeAddresses { tori: records.address.into(), ids: level.ids.address.into() };
        Ok(Self {
            tlas,
            addresses: Buffer::with_data(gpu, "shapes", &[addresses], input_usage())?,
            bounds: everything,
            reach,
            build,
            _level: level.blas,
            _buffers: vec![records, level.ids],
        })
    }

    /// Tests whether they must be rebuilt, for other parameters or because the eye has moved far.
    pub fn is_outdated(&self, build: Build, eye: Vec3) -> bool {
        build != self.build || reach(self.bounds, eye) != self.reach
    }
}
