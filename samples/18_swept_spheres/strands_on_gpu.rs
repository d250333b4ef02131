//! The strands on the device: a bottom level of boxes, in order, beside the meshes.

use anyhow::{Result, ensure};
use common::gpu::order::{self, around};
use common::gpu::{AccelerationStructure, Buffer, Gpu, reach};
use common::scene::{
    Instance, Scene, SceneOnGpu, SceneOptions, build_top, input_usage, instance_on_gpu,
};
use glam::{Affine3A, Vec3};

use crate::boxes;
use crate::scenes::{self, SceneKind};
use crate::strands::{StrandAddresses, Strands};
use crate::tubes;

/// Maximum number of triangles in the tubes of all strands.
const MOST_TRIANGLES: usize = 1 << 24;

common::shader_enum! {
    /// The device's geometry: boxes and an intersection shader, or triangles.
    pub enum Shape { Swept, Triangles }
}

/// Parameters of the strands; a change rebuilds them.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub scene: SceneKind,
    pub hairs: u32,
    pub shape: Shape,
    /// Of a tube of triangles.
    pub sides: u32,
}

/// The strands in device memory, and the top level that holds them beside the meshes.
pub struct StrandsOnGpu {
    pub tlas: AccelerationStructure,
    /// The meshes: those of the board, and of the strands where they are triangles.
    pub scene: SceneOnGpu,
    /// The buffer with the addresses of the strands: a [`StrandAddresses`].
    pub addresses: Buffer,
    /// Corners of the box around everything.
    bounds: order::Bounds,
    /// Bound on the distance from a ray's origin to a strand; the margin of the boxes grows with it.
    reach: f32,
    build: Build,
    _level: Option<AccelerationStructure>,
    _buffers: Vec<Buffer>,
}

impl StrandsOnGpu {
    /// `source` is the board; its last materials are those of the strands. Textures that are on the device
    /// already stay there.
    pub fn new(
        gpu: &Gpu,
        source: &Scene,
        build: Build,
        options: SceneOptions,
        eye: Vec3,
        old: Option<&Self>,
    ) -> Result<Self> {
        let material = source.model.materials.len() - scenes::materials().count();
        let strands = Strands::new(build.scene, build.hairs, material as u32);
        let mut source = source.clone();
        if build.scene != SceneKind::Board {
            source.instances.clear();
        }
        if build.shape == Shape::Triangles {
            let count = tubes::count(&strands, build.sides);
            ensure!(
                count <= MOST_TRIANGLES,
                "tubes of {} sides for {} segments have {count} triangles, and at most {MOST_TRIANGLES} are made: take fewer \
                 hairs or sides",
                build.sides,
                strands.segments.len()
            );
            for mesh in tubes::meshes(&strands, build.sides) {
                let material = mesh.material;
                let transform = Affine3A::IDENTITY;
                let mesh_index = source.model.meshes.len();
                source.model.meshes.push(mesh);
                source.instances.push(Instance {
                    mesh: mesh_index,
                    transform,
                    material,
                    record_offset: 0,
                });
            }
        }
        let scene = SceneOnGpu::with_textures(
            gpu,
            &source,
            options,
            old.map(|old| old.scene.textures.clone()),
        )?;

        let bounds = strands.bounds();
        let all = around(bounds.iter().chain(&source.bounds_of_instances()));
        let reach = reach(all, eye);
        let order = order::for_build(gpu, &bounds, options.ordering);
        let ids = Buffer::with_data(gpu, "order of segments", &order, input_usage())?;
        let mut boxes_of = source.bounds_of_instances();
        let placed = source.instances.iter().enumerate();
        let mut instances: Vec<_> = placed
            .map(|(i, at)| instance_on_gpu(&at.transform, i, 0, &scene.blas[at.mesh]))
            .collect();
        let mut level = None;
        if build.shape == Shape::Swept {
            let ordered = order.iter().map(|&i| bounds[i as usize]);
            let blas = level.insert(boxes::bottom(gpu, "strands", ordered, reach)?);
            instances.push(instance_on_gpu(&Affine3A::IDENTITY, source.instances.len(), 1, blas));
            boxes_of.push(around(&bounds));
        }
        let ordered = order::for_build(gpu, &boxes_of, options.ordering);
        let ordered: Vec<_> = ordered.iter().map(|&i| instances[i as usize]).collect();
        let tlas = build_top(gpu, &ordered)?;

        let nodes = Buffer::with_data(gpu, "nodes", &strands.nodes, input_usage())?;
        let segments = Buffer::with_data(gpu, "segments", &strands.segments, input_usage())?;
        let addresses = StrandAddresses {
            nodes: nodes.address.into(),
            segments: segments.address.into(),
            ids: ids.address.into(),
        };
        Ok(Self {
            tlas,
            scene,
            addresses: Buffer::with_data(gpu, "strands", &[addresses], input_usage())?,
            bounds: all,
            reach,
            build,
            _level: level,
            _buffers: vec![nodes, segments, ids],
        })
    }

    /// Tests whether they must be rebuilt, for other parameters or because the eye has moved far.
    pub fn is_outdated(&self, build: Build, eye: Vec3) -> bool {
        build != self.build || reach(self.bounds, eye) != self.reach
    }
}
