//! The shapes on the device: a bottom level of spheres and one of boxes, in order.

use anyhow::Result;
use ash::vk;
use common::Frame;
use common::gpu::{AccelerationStructure, Address, Buffer, Gpu, order};
use common::scene::{Instance, Scene, SceneOnGpu, build_top, input_usage, instance_on_gpu};
use glam::{Affine3A, Vec3};

use crate::boxes::{self, reach};
use crate::order::Order;
use crate::shapes::{self, SceneKind, ShapeAddresses, Shapes};
use crate::tree::{self, Node};

/// What the shapes are built from; where it changes, they are built again.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub scene: SceneKind,
    pub count: u32,
    pub order: Order,
    /// Whether the boxes around shapes are larger than the shapes.
    pub margin: bool,
}

/// The shapes in device memory, and the top level that holds them beside the meshes.
pub struct ShapesOnGpu {
    pub tlas: AccelerationStructure,
    /// Where shaders find the shapes: a [`ShapeAddresses`].
    pub addresses: Buffer,
    /// How many boxes a line through all spheres, or all boxes, is expected to be tested against.
    pub expected_tests: [f64; 2],
    /// |eye - center|² - radius² of each sphere, for this eye.
    host_c: Option<(Vec3, Buffer)>,
    shapes: Shapes,
    /// Corners of the box around everything.
    bounds: order::Bounds,
    /// How far rays may begin from a shape; the margin of the boxes grows with it.
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
        let shapes = Shapes::new(build.scene, build.count, &source.model, &source.instances);
        let spheres: Vec<_> = shapes.spheres.iter().map(shapes::Sphere::bounds).collect();
        let boxes: Vec<_> = shapes.boxes.iter().map(|b| (b.low, b.high)).collect();
        // In the other scenes there are no triangles, and in this one fewer.
        let is_shown = |(_, piece): &(usize, &Instance)| {
            build.scene == SceneKind::Chess && !shapes::is_replaced(&source.model, piece)
        };
        let pieces: Vec<_> = source.instances.iter().enumerate().filter(is_shown).collect();
        let mut bounds: Vec<_> =
            pieces.iter().map(|(_, piece)| source.instance_bounds(piece)).collect();
        let everything = around(bounds.iter().chain(&spheres).chain(&boxes));
        let reach = if build.margin { reach(everything, eye) } else { 0.0 };

        let ordering = scene.options.ordering;
        let mut instances = Vec::new();
        for (index, piece) in pieces {
            let blas = &scene.blas[piece.mesh];
            instances.push(instance_on_gpu(&piece.transform, index, 0, blas));
        }
        // One more instance for all spheres and one for all boxes. The record offset makes the device
        // run their intersection shaders: hit group 0 is that of triangles, 1 of spheres, 2 of boxes.
        let spheres = Level::new(gpu, "spheres", &spheres, build.order, reach)?;
        let boxes = Level::new(gpu, "boxes", &boxes, build.order, reach)?;
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
                &spheres.built(&shapes.spheres),
                input_usage(),
            )?,
            Buffer::with_data(gpu, "boxes as built", &boxes.built(&shapes.boxes), input_usage())?,
        ];
        let first = spheres.tree.len() as u32;
        let behind = boxes.tree.iter().map(|node| Node { next: first + node.next, ..*node });
        let tree: Vec<Node> = spheres.tree.iter().copied().chain(behind).collect();
        let tree_at = Buffer::with_data(gpu, "tree", &tree, input_usage())?;
        let expected_tests = [&spheres, &boxes].map(|level| tree::expected_tests(&level.tree));

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
            host_c: None,
            shapes,
            bounds: everything,
            reach,
            build,
            _levels: [spheres.blas, boxes.blas].into_iter().flatten().collect(),
            _buffers: records.into_iter().chain(copies).chain([tree_at]).collect(),
        })
    }

    /// Whether they must be made again, for another build or because the eye has gone far.
    pub fn is_outdated(&self, build: Build, eye: Vec3) -> bool {
        let reach = if build.margin { reach(self.bounds, eye) } else { 0.0 };
        build != self.build || reach != self.reach
    }

    /// c of the quadratic for rays from the eye: products and sums of f32 numbers, in f64.
    pub fn compute_host_c(&mut self, frame: &Frame, eye: Vec3) -> Result<()> {
        if self.host_c.as_ref().is_some_and(|(known, _)| *known == eye) {
            return Ok(());
        }
        let c = self.shapes.spheres.iter().map(|sphere| {
            let radius = f64::from(sphere.radius);
            let distance = (eye.as_dvec3() - sphere.center.as_dvec3()).length();
            ((distance - radius) * (distance + radius)) as f32
        });
        let c: Vec<f32> = c.collect();
        let buffer = match self.host_c.take() {
            Some((_, buffer)) => buffer,
            None => {
                let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
                Buffer::new(frame.gpu, "c of spheres", 4 * c.len() as u64, usage)?
            }
        };
        buffer.update(frame.cmd, &c)?;
        self.host_c = Some((eye, buffer));
        Ok(())
    }

    /// Where c lies; nowhere before it was computed.
    pub fn host_c_address(&self) -> Address {
        self.host_c.as_ref().map_or(0, |(_, buffer)| buffer.address).into()
    }
}

/// All shapes of one kind as a bottom level.
struct Level {
    /// `None` without shapes.
    blas: Option<AccelerationStructure>,
    /// Which shape a primitive of the build is.
    ids: Buffer,
    order: Vec<u32>,
    tree: Vec<Node>,
    bounds: order::Bounds,
}

impl Level {
    fn new(
        gpu: &Gpu,
        name: &str,
        bounds: &[order::Bounds],
        order: Order,
        reach: f32,
    ) -> Result<Self> {
        // ANCHOR: order
        let order = gpu.driver_shim.order(order.of(bounds));
        let ordered: Vec<_> = order.iter().map(|&i| bounds[i as usize]).collect();
        let ids = Buffer::with_data(gpu, name, &order, input_usage())?;
        // ANCHOR_END: order
        let tree = tree::nodes(&ordered);
        let blas =
            (!bounds.is_empty()).then(|| boxes::bottom(gpu, name, ordered, reach)).transpose()?;
        Ok(Self { blas, ids, order, tree, bounds: around(bounds) })
    }

    /// Things in the order of the build.
    fn built<T: Copy>(&self, things: &[T]) -> Vec<T> {
        self.order.iter().map(|&i| things[i as usize]).collect()
    }
}

/// The box around boxes.
fn around<'a>(bounds: impl IntoIterator<Item = &'a order::Bounds>) -> order::Bounds {
    let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    bounds.into_iter().fold(nothing, |(low, high), (l, h)| (low.min(*l), high.max(*h)))
}
