//! A device, a scene with trees of both kinds, and rays traced by walks, by queries or by brute force.

use std::sync::Arc;

use common::glam::Vec3;
use common::gpu::{
    Address, Binding, Buffer, ComputePipeline, Descriptor, Gpu, GpuOptions, HitGroup,
    RayTracingPipeline, Requirements, ShaderBindingTable, Timer,
};
use common::scene::{Scene, SceneOnGpu, SceneOptions};
use instruments::arithmetic::Arithmetic;
use own_tree::{Builder, OwnScene, RAYS, TRACED, Trees};

pub const NAME: &str = "30_own_tree";
pub const NOTHING: u32 = u32::MAX;
/// The largest workgroup: smaller if the device requires it, and every device supports 128.
const WORKGROUP: u32 = 256;
/// Invocations per row of a dispatch.
const ACROSS: u32 = 1 << 12;

common::shader_struct! {
    /// A ray from t = 0 to `tmax`.
    pub struct Given {
        pub origin: Vec3,
        pub tmax: f32,
        pub direction: Vec3,
        pub any: u32,
    }
}

common::shader_struct! {
    pub struct Answer {
        pub t: f32,
        pub instance: u32,
        pub position: u32,
        pub count: u32,
    }
}

common::shader_struct! {
    struct Launch {
        trees: Address<Trees>,
        given: Address<Given>,
        answers: Address<Answer>,
        rays: u32,
        across: u32,
        instances: u32,
    }
}

/// The tracer of the rays.
#[derive(Clone, Copy)]
pub enum By {
    Walk,
    All,
    /// The device's own: its ray queries, or its pipeline if it has no queries.
    Device,
}

/// A way to trace rays.
pub enum Way {
    Computed(ComputePipeline),
    Queried(ComputePipeline),
    Traced(Box<(RayTracingPipeline, ShaderBindingTable)>),
}

/// The tests of boxes and triangles, as the numbers of the chapter's choices.
#[derive(Clone, Copy)]
pub struct Rungs {
    pub boxes: u32,
    pub triangles: u32,
    pub quantised: bool,
    /// True if nodes are read in 64-bit words where the device can.
    pub words: bool,
}

pub const BARE: u32 = 0;
pub const BOUND: u32 = 3;
pub const EXACT: u32 = 4;
pub const MOELLER: u32 = 0;
pub const WATERTIGHT: u32 = 1;
pub const TWO_FLOAT: u32 = 2;

pub const BEST: Rungs =
    Rungs { boxes: BOUND, triangles: WATERTIGHT, quantised: false, words: true };
pub const PACKED: Rungs = Rungs { quantised: true, ..BEST };
pub const SINGLE: Rungs = Rungs { words: false, ..BEST };

/// The processor time of this process's threads, in seconds.
fn worked() -> f64 {
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let nanoseconds = threads.filter_map(|thread| {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    nanoseconds.sum::<f64>() * 1e-9
}

pub struct Rig {
    pub gpu: Gpu,
    pub own: OwnScene,
    /// True if the device supports queries and they are enabled.
    pub queries: bool,
    /// The device's own acceleration structures, if they are used.
    pub levels: Option<SceneOnGpu>,
    instances: u32,
}

impl Rig {
    /// A rig for walks only.
    pub fn new(scene: &Scene, builder: Builder) -> Self {
        Self::make(scene, builder, false, Arithmetic::Driver)
    }

    /// A rig for walks in the given arithmetic.
    pub fn in_arithmetic(scene: &Scene, builder: Builder, arithmetic: Arithmetic) -> Self {
        Self::make(scene, builder, false, arithmetic)
    }

    /// A rig for walks and the device's own traversal, without validation, which would distort the times.
    pub fn beside_the_device(scene: &Scene, builder: Builder) -> Self {
        Self::make(scene, builder, true, Arithmetic::Driver)
    }

    fn make(scene: &Scene, builder: Builder, beside: bool, arithmetic: Arithmetic) -> Self {
        let driver_shim = Arc::new(arithmetic);
        let device = |requirements| {
            let driver_shim = driver_shim.clone();
            let options = GpuOptions {
                requirements,
                validate: !beside,
                driver_shim,
                ..GpuOptions::default()
            };
            Gpu::new(&options)
        };
        let requirements = || Requirements::ray_tracing().textures().int64_where_offered();
        let with_queries = if beside { device(requirements().ray_query()).ok() } else { None };
        let queries = with_queries.is_some();
        let gpu =
            with_queries.unwrap_or_else(|| device(requirements()).expect("there is a device"));
        let own = OwnScene::new(&gpu, scene, builder).expect("it has room");
        let levels = beside
            .then(|| SceneOnGpu::new(&gpu, scene, SceneOptions::default()).expect("it has room"));
        Self { gpu, own, queries, levels, instances: scene.instances.len() as u32 }
    }

    /// A way to trace rays.
    pub fn way(&self, by: By, rungs: Rungs) -> Way {
        let traced = |gpu: &Gpu| {
            let [raygen, miss, closest_hit] = TRACED;
            RayTracingPipeline::builder(NAME)
                .raygen(raygen)
                .miss(miss)
                .hit(HitGroup::triangles().closest_hit(closest_hit))
                .binding(Binding::AccelerationStructure)
                .push_constants::<Launch>()
                .build(gpu)
        };
        let most = self.gpu.limits.core.max_compute_work_group_invocations;
        let computed = || {
            let walk = ComputePipeline::builder(NAME)
                .compute(RAYS)
                .workgroup(4, [WORKGROUP.min(most), 1])
                .constant(1, rungs.boxes)
                .constant(2, rungs.triangles)
                .constant(3, self.own.trees.stack)
                .constant(6, u32::from(rungs.quantised))
                .push_constants::<Launch>()
                .rounding_to_nearest_even(&self.gpu);
            if rungs.words { walk.int64(&self.gpu) } else { walk }
        };
        let way = match by {
            By::Walk => computed().build_compute(&self.gpu).map(Way::Computed),
            By::All => computed().define("BY_ALL", 1).build_compute(&self.gpu).map(Way::Computed),
            By::Device if self.queries => computed()
                .define("BY_QUERY", 1)
                .binding(Binding::AccelerationStructure)
                .build_compute(&self.gpu)
                .map(Way::Queried),
            By::Device => traced(&self.gpu).and_then(|pipeline| {
                let table = ShaderBindingTable::new(&self.gpu, &pipeline)?;
                Ok(Way::Traced(Box::new((pipeline, table))))
            }),
        };
        way.expect("it compiles")
    }

    /// The answer to each ray, and the time in milliseconds: processor time for a software device, otherwise
    /// by the device's clock.
    pub fn answers(&self, way: &Way, given: &[Given]) -> (Vec<Answer>, f64) {
        let rays =
            Buffer::with_data(&self.gpu, "rays", given, Buffer::ADDRESSED).expect("room for rays");
        let size = size_of::<Answer>() * given.len();
        let usage = Buffer::ADDRESSED | ash::vk::BufferUsageFlags::TRANSFER_SRC;
        let answers = Buffer::new(&self.gpu, "answers", size as u64, usage).expect("room");
        let launch = Launch {
            trees: self.own.trees.address,
            given: rays.address.into(),
            answers: answers.address.into(),
            rays: given.len() as u32,
            across: ACROSS,
            instances: self.instances,
        };
        let levels = self.levels.iter();
        let levels: Vec<_> =
            levels.map(|levels| Descriptor::AccelerationStructure(&levels.tlas)).collect();
        let rows = (given.len() as u32).div_ceil(ACROSS);
        let area = ash::vk::Extent2D { width: ACROSS, height: rows }.into();
        let timer = Timer::new(&self.gpu).expect("room for a timer");
        let begun = worked();
        self.gpu
            .submit(|cmd| {
                timer.start(cmd);
                match way {
                    Way::Computed(pipeline) => {
                        pipeline.bind(cmd, &[], &launch)?;
                        pipeline.dispatch(cmd, area);
                    }
                    Way::Queried(pipeline) => {
                        pipeline.bind(cmd, &levels, &launch)?;
                        pipeline.dispatch(cmd, area);
                    }
                    Way::Traced(traced) => {
                        let (pipeline, table) = &**traced;
                        pipeline.bind(cmd, &levels, &launch)?;
                        table.trace(cmd, area);
                    }
                }
                timer.stop(cmd);
                Ok(())
            })
            .expect("the device does it");
        let milliseconds = if self.gpu.chosen.software {
            (worked() - begun) * 1e3
        } else {
            timer.milliseconds().expect("the device has a clock")
        };
        (answers.read().expect("they come back"), milliseconds)
    }
}
