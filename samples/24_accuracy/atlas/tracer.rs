//! Traces the atlas's rays, and hands out what each has found.

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, ShaderBindingTable,
    barrier,
};
use common::scene::input_usage;
use glam::{Vec2, Vec3};

use super::world::{Traversal, World};
use crate::query::Ray;

/// Maximum number of recorded any-hit calls per ray, as in atlas.glsl.
const MOST: usize = 16;
/// The primitive of a ray that hit nothing, as in atlas.glsl.
pub const NOTHING: u32 = u32::MAX;
/// Rays of a launch: some milliseconds of any device.
const AT_ONCE: usize = 1 << 16;
/// Rays of a launch's row, as some devices take no more than 2^16 in one direction.
const WIDTH: u32 = 1024;

common::shader_struct! {
    struct Aim {
        origin: Vec3,
        tmin: f32,
        direction: Vec3,
        tmax: f32,
    }
}

common::shader_struct! {
    /// A primitive reported by the device for a ray, and its hit.
    pub struct Met {
        /// Of the build; what [`Answer`] hands out is the shape's number instead.
        pub primitive: u32,
        /// In lengths of the ray's direction.
        pub t: f32,
        /// Of the second and the third corner.
        pub barycentrics: Vec2,
    }
}

common::shader_struct! {
    struct Found {
        nearest: Met,
        calls: u32,
    }
}

common::shader_struct! {
    struct Push {
        aims: Address<Aim>,
        founds: Address<Found>,
        calls: Address<Met>,
        corners: Address,
        fetched: Address,
        count: u32,
    }
}

/// The result of a ray.
pub struct Answer<'a> {
    /// The nearest hit where all was opaque.
    pub nearest: Option<Met>,
    /// The calls of any-hit shaders where nothing was opaque, in order.
    pub calls: &'a [Met],
    /// Number of calls; more than [`Answer::calls`] has if they are beyond 16.
    pub called: u32,
}

/// The scene to trace rays against.
#[derive(Clone, Copy, PartialEq)]
pub enum What {
    Triangles(Traversal),
    Boxes,
    /// Triangles whose corners the device hands out.
    Corners,
}

/// A pipeline that traces at one kind of world.
pub struct Tracer {
    gpu: Gpu,
    what: What,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
}

/// The results of a launch.
struct Launched {
    founds: Vec<Found>,
    /// A row of [`MOST`] a ray.
    calls: Vec<Met>,
    /// The vertices of each ray's triangle, if the device provides them; zeros if a ray missed.
    corners: Vec<[Vec3; 3]>,
}

impl Tracer {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn new(gpu: &Gpu, what: What) -> Result<Self> {
        let noted =
            |group: HitGroup<'static>| group.any_hit("atlas.rahit").closest_hit("atlas.rchit");
        let group = match what {
            What::Triangles(Traversal::Device) => noted(HitGroup::triangles()),
            What::Triangles(Traversal::Software) => {
                noted(HitGroup::procedural("atlas_triangle.rint"))
            }
            What::Boxes => noted(HitGroup::procedural("atlas_box.rint")),
            What::Corners => HitGroup::triangles().closest_hit("atlas_corners.rchit"),
        };
        let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
            .raygen("atlas.rgen")
            .miss("atlas.rmiss")
            .hit(group)
            .binding(Binding::AccelerationStructure)
            .push_constants::<Push>()
            .build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        Ok(Self { gpu: gpu.clone(), what, pipeline, sbt })
    }

    /// Traces rays, and returns the result of each, in order.
    ///
    /// # Errors
    /// If the device fails.
    pub fn trace(
        &self,
        world: &World,
        rays: &[Ray],
        mut tell: impl FnMut(usize, &Answer),
    ) -> Result<()> {
        for (part, rays) in rays.chunks(AT_ONCE).enumerate() {
            let Launched { founds, mut calls, .. } = self.launch(world, rays)?;
            for (i, found) in founds.iter().enumerate() {
                let noted = (found.calls as usize).min(MOST);
                let calls = &mut calls[i * MOST..][..noted];
                for call in &mut *calls {
                    call.primitive = world.shape(call.primitive);
                }
                let shape = world.shape(found.nearest.primitive);
                let nearest =
                    (shape != NOTHING).then_some(Met { primitive: shape, ..found.nearest });
                tell(part * AT_ONCE + i, &Answer { nearest, calls, called: found.calls });
            }
        }
        Ok(())
    }

    /// The corners that the device hands out of each ray's triangle; zeros where a ray misses.
    ///
    /// # Errors
    /// If the device fails.
    pub fn corners(&self, world: &World, rays: &[Ray]) -> Result<Vec<[Vec3; 3]>> {
        let mut corners = Vec::with_capacity(rays.len());
        for rays in rays.chunks(AT_ONCE) {
            corners.extend(self.launch(world, rays)?.corners);
        }
        Ok(corners)
    }

    fn launch(&self, world: &World, rays: &[Ray]) -> Result<Launched> {
        let gpu = &self.gpu;
        let aim = |ray: &Ray| {
            let &Ray { origin, direction, tmin, tmax } = ray;
            Aim { origin, tmin, direction, tmax }
        };
        let aims: Vec<Aim> = rays.iter().map(aim).collect();
        let aims = Buffer::with_data(gpu, "aims", &aims, input_usage())?;
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_SRC;
        let room = |name, each: usize| Buffer::new(gpu, name, (rays.len() * each) as u64, usage);
        let founds = room("founds", size_of::<Found>())?;
        let calls = room("calls", MOST * size_of::<Met>())?;
        let is_fetched = self.what == What::Corners;
        let zeros = vec![[Vec3::ZERO; 3]; if is_fetched { rays.len() } else { 0 }];
        let fetched = Buffer::with_data(gpu, "fetched corners", &zeros, usage)?;
        let push = Push {
            aims: aims.address.into(),
            founds: founds.address.into(),
            calls: calls.address.into(),
            corners: world.corners.address.into(),
            fetched: fetched.address.into(),
            count: rays.len() as u32,
        };
        let width = push.count.min(WIDTH);
        let extent = vk::Extent2D { width, height: push.count.div_ceil(width) };
        gpu.submit(|cmd| {
            let tlas = Descriptor::AccelerationStructure(&world.tlas);
            self.pipeline.bind(cmd, &[tlas], &push)?;
            self.sbt.trace(cmd, extent.into());
            barrier::trace_to_trace(gpu, cmd);
            Ok(())
        })?;
        let corners = if is_fetched { fetched.read()? } else { Vec::new() };
        Ok(Launched { founds: founds.read()?, calls: calls.read()?, corners })
    }
}
