//! The shapes on the device: a bottom level of spheres and one of boxes, in order.

use anyhow::Result;
use common::gpu::order::{self, around};
use common::gpu::{AccelerationStructure, Address, Buffer, Gpu, reach};
use common::scene::{Instance, Scene, SceneOnGpu, build_top, input_usage, instance_on_gpu};
use glam::{Affine3A, Vec3};

use crate::level::Level;
use crate::order::Order;
use crate::scenes::{self, SceneKind};
use crate::shapes::{self, Box, Sphere};
use crate::tree::{self, Node};

/// Parameters of the shapes; a change rebuilds them.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub scene: SceneKind,
    pub count: u32,
    pub order: Order,
}

common::shader_struct! {
    /// Addresses of the shapes, the shape of each primitive of the build, and the trees.
    pub struct ShapeAddresses {
        pub spheres: Address<Sphere>,
        pub boxes: Address<Box>,
        pub sphere_ids: Address,
        pub box_ids: Address,
        pub built_spheres: Address<Sphere>,
        pub built_boxes: Address<Box>,
        pub tree: Address<Node>,
        pub nodes: u32,
        pub sphere_count: u32,
        pub box_count: u32,
    }
}

/// The shapes in device memory, and the top level that holds them beside the meshes.
pub struct ShapesOnGpu {
    pub tlas: AccelerationStructure,
    /// The buffer with the addresses of the shapes: a [`ShapeAddresses`].
    pub addresses: Buffer,
    /// Expected number of boxes tested against a line through all spheres, or all boxes.
    pub expected_tests: [f64; 2],
    /// Corners of the box around everything.
    bounds: order::Bounds,
    /// Bound on the distance from a ray's origin to a shape; the padding of the boxes grows with it.
    reach: f32,
    build: Build,
    _levels: Vec<AccelerationStructure>,
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
        let shapes = scenes::shapes(build.scene, build.count, &source.model, &source.instances);
        let spheres: Vec<_> = shapes.spheres.iter().map(Sphere::bounds).collect();
        let boxes: Vec<_> = shapes.boxes.iter().map(|b| (b.low, b.high)).collect();
        // In the other scenes there are no triangles, and in this one fewer.
        let is_shown = |(_, piece): &(usize, &Instance)| {
            build.scene == SceneKind::Chess && !shapes::is_replaced(&source.model, piece)
        };
        let pieces: Vec<_> = source.instances.iter().enumerate().filter(is_shown).collect();
        let mut bounds: Vec<_> =
            pieces.iter().map(|(_, piece)| source.instance_bounds(piece)).collect();
        let everything = around(bounds.iter().chain(&spheres).chain(&boxes));
        let reach = reach(everything, eye);

        // ANCHOR: order
        let orders = [&spheres, &boxes].map(|bounds| gpu.driver_shim.order(build.order.of(bounds)));
        // ANCHOR_END: order
        let trees = [built(&orders[0], &spheres), built(&orders[1], &boxes)]
            .map(|ordered| tree::nodes(&ordered));

        let ordering = scene.options.ordering;
        let mut instances = Vec::new();
        for (index, piece) in pieces {
            let blas = &scene.blas[piece.mesh];
            instances.push(instance_on_gpu(&piece.transform, index, 0, blas));
        }
        // One more instance for all spheres and one for all boxes. The record offset makes the device
        // run their intersection shaders: hit group 0 is that of triangles, 1 of spheres, 2 of boxes.
        let spheres = Level::new(gpu, "spheres", &spheres, &orders[0], reach)?;
        let boxes = Level::new(gpu, "boxes", &boxes, &orders[1], reach)?;
        for (record, level) in [(1, &spheres), (2, &boxes)] {
            if let Some(blas) = &level.blas {
                let index = source.instances.len() + record as usize - 1;
                instances.push(instance_on_gpu(&Affine3A::IDENTITY, index, record, blas));
                bounds.push(level.bounds);
            }
        }
        let ordered = order::for_build(gpu, &bounds, ordering);
        let ordered: Vec<_> = ordered.iter().map(|&i| instances[i as usize]).collect();
        let tlas = build_top(gpu, &ordered)?;

        let copies = [
            Buffer::with_data(
                gpu,
                "spheres as built",
                &built(&orders[0], &shapes.spheres),
                input_usage(),
            )?,
            Buffer::with_data(
                gpu,
                "boxes as built",
                &built(&orders[1], &shapes.boxes),
                input_usage(),
            )?,
        ];
        let first = trees[0].len() as u32;
        let behind = trees[1].iter().map(|node| Node { next: first + node.next, ..*node });
        let tree: Vec<Node> = trees[0].iter().copied().chain(behind).collect();
        let tree_at = Buffer::with_data(gpu, "tree", &tree, input_usage())?;
        let expected_tests = trees.each_ref().map(|tree| tree::expected_tests(tree));

        let records = [
            Buffer::with_data(gpu, "spheres", &shapes.spheres, input_usage())?,
            Buffer::with_data(gpu, "boxes", &shapes.boxes, input_usage())?,
            spheres.ids,
            boxes.ids,
        ];
        let [spheres_at, boxes_at, sphere_ids, box_ids] =
            records.each_ref().map(|buffer| buffer.address);
        let addresses = ShapeAddresses {
            spheres: spheres_at.into(),
            boxes: boxes_at.into(),
            sphere_ids: sphere_ids.into(),
            box_ids: box_ids.into(),
            built_spheres: copies[0].address.into(),
            built_boxes: copies[1].address.into(),
            tree: tree_at.address.into(),
            nodes: tree.len() as u32,
            sphere_count: shapes.spheres.len() as u32,
            box_count: shapes.boxes.len() as u32,
        };
        Ok(Self {
            tlas,
            expected_tests,
            addresses: Buffer::with_data(gpu, "shapes", &[addresses], input_usage())?,
            bounds: everything,
            reach,
            build,
            _levels: [spheres.blas, boxes.blas].into_iter().flatten().collect(),
            _buffers: records.into_iter().chain(copies).chain([tree_at]).collect(),
        })
    }

    /// Tests whether they must be rebuilt, for other parameters or because the eye has moved far.
    pub fn is_outdated(&self, build: Build, eye: Vec3) -> bool {
        build != self.build || reach(self.bounds, eye) != self.reach
    }
}

/// Things in the order of the build.
fn built<T: Copy>(order: &[u32], things: &[T]) -> Vec<T> {
    order.iter().map(|&i| things[i as usize]).collect()
}
