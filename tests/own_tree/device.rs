//! Trees built on the device and read back: every triangle once, exact boxes, and the same hierarchy as a
//! plain build from the same codes.

mod builds;
mod karras;
mod refits;
mod shapes;

use std::sync::Arc;

use ash::vk::BufferUsageFlags as Usage;
use common::gpu::{Buffer, Gpu, GpuOptions, Requirements};
use common::scene::{Mesh, Vertex, input_usage};
use glam::{Vec2, Vec3};
use instruments::arithmetic::Arithmetic;
use own_tree::{Child, Corners, DeviceBuilder, DeviceTree, Node, Scratch, Triangles};
use shapes::Shape;

fn gpu(validate: bool, arithmetic: Arithmetic) -> Gpu {
    let (requirements, driver_shim) = (Requirements::ray_tracing(), Arc::new(arithmetic));
    Gpu::new(&GpuOptions { requirements, validate, driver_shim, ..GpuOptions::default() }).unwrap()
}

/// Without validation, which would distort the times.
pub fn gpu_to_be_timed() -> Gpu {
    gpu(false, Arithmetic::Driver)
}

/// Triangles on the device, ready for a build.
pub struct Uploaded {
    pub vertices: Buffer,
    pub triangles: Buffer,
    pub count: u32,
}

impl Uploaded {
    fn new(gpu: &Gpu, shape: &Shape) -> Self {
        let vertices: Vec<Vertex> = shape.vertices.iter().map(|at| vertex(*at)).collect();
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        Self::upload(gpu, &vertices, &shape.triangles, usage)
    }

    /// With the usages for builds of all kinds.
    pub fn of_mesh(gpu: &Gpu, mesh: &Mesh) -> Self {
        Self::upload(gpu, &mesh.vertices, &mesh.triangles, input_usage())
    }

    fn upload(gpu: &Gpu, vertices: &[Vertex], triangles: &[[u32; 3]], usage: Usage) -> Self {
        Self {
            vertices: Buffer::with_data(gpu, "vertices", vertices, usage).unwrap(),
            triangles: Buffer::with_data(gpu, "triangles", triangles, usage).unwrap(),
            count: triangles.len() as u32,
        }
    }

    pub fn input(&self) -> Triangles {
        let (vertices, triangles) = (self.vertices.address, self.triangles.address);
        Triangles { vertices, triangles, count: self.count }
    }
}

fn vertex(position: Vec3) -> Vertex {
    Vertex { position, normal: Vec3::Y, uv: Vec2::ZERO }
}

/// A tree built and read back.
#[derive(Clone, Debug)]
struct Built {
    nodes: Vec<Node>,
    original: Vec<u32>,
    corners: Vec<Corners>,
    most_depth: u32,
}

impl Built {
    fn read(tree: &DeviceTree) -> Self {
        let count = tree.count as usize;
        let mut built = Self {
            nodes: tree.nodes.read().unwrap(),
            original: tree.original.read().unwrap(),
            corners: tree.corners.read().unwrap(),
            most_depth: tree.most_depth(),
        };
        // Vulkan has no empty buffers.
        built.original.truncate(count);
        built.corners.truncate(count);
        assert_eq!(built.nodes.len(), count.saturating_sub(1).max(1));
        built
    }

    fn bytes(&self) -> [&[u8]; 3] {
        [
            bytemuck::cast_slice(&self.nodes),
            bytemuck::cast_slice(&self.original),
            bytemuck::cast_slice(&self.corners),
        ]
    }
}

/// The scenes and programs shared by the tests of one device.
struct Bench {
    gpu: Gpu,
    builder: DeviceBuilder,
    scratch: Scratch,
}

impl Bench {
    fn new() -> Self {
        Self::with(Arithmetic::Driver)
    }

    fn with(arithmetic: Arithmetic) -> Self {
        let gpu = gpu(true, arithmetic);
        let builder = DeviceBuilder::new(&gpu).unwrap();
        let scratch = Scratch::new(&gpu, 100_000).unwrap();
        Self { gpu, builder, scratch }
    }

    fn build(&self, shape: &Shape) -> (DeviceTree, Uploaded) {
        let input = Uploaded::new(&self.gpu, shape);
        let tree = DeviceTree::new(&self.gpu, input.count).unwrap();
        let record = |cmd| self.builder.record(cmd, input.input(), &tree, &self.scratch);
        self.gpu.submit(record).unwrap();
        (tree, input)
    }

    /// Builds a tree and checks all of its promises.
    fn checked(&self, shape: &Shape) -> Built {
        let built = Built::read(&self.build(shape).0);
        check(shape, &built);
        self.is_silent();
        built
    }

    fn is_silent(&self) {
        assert_eq!(self.gpu.validation().all(), [""; 0]);
    }
}

/// The bounding box of a triangle, if it is finite.
fn box_of(corners: [Vec3; 3]) -> Option<(Vec3, Vec3)> {
    let [a, b, c] = corners;
    corners.iter().all(|corner| corner.is_finite()).then(|| (a.min(b).min(c), a.max(b).max(c)))
}

/// Checks that each finite triangle is in exactly one leaf, that each node is reached once, and that boxes
/// are exact.
fn check(shape: &Shape, built: &Built) {
    let name = &shape.name;
    let finite = shape.triangles.iter().filter(|t| box_of(shape.corners(**t)).is_some()).count();
    let mut all = built.original.clone();
    all.sort_unstable();
    assert!(all.into_iter().eq(0..shape.triangles.len() as u32), "{name}: a permutation");
    for (corners, &triangle) in built.corners.iter().zip(&built.original) {
        let expected = shape.corners(shape.triangles[triangle as usize]);
        assert_eq!(bytemuck::bytes_of(corners), bytemuck::bytes_of(&expected), "{name}");
    }
    let mut leaves = vec![0; built.original.len()];
    let mut reached = vec![0; built.nodes.len()];
    let mut deepest = 0;
    // Each node with its box in its parent, and the number of nodes on the path to it, including itself.
    let mut open: Vec<(usize, Option<Child>, u32)> = vec![(0, None, 1)];
    while let Some((index, of_parent, depth)) = open.pop() {
        reached[index] += 1;
        deepest = deepest.max(depth);
        let children = built.nodes[index].children;
        if let Some(expected) = of_parent {
            let low = children[0].low.min(children[1].low);
            let high = children[0].high.max(children[1].high);
            let expected = seen((expected.low, expected.high));
            assert_eq!(expected, seen((low, high)), "{name}: node {index}");
        }
        for child in children {
            let (first, is_none) = (child.first as usize, child.low.x > child.high.x);
            match (child.count, is_none) {
                (0, true) => {
                    assert_eq!(bytemuck::bytes_of(&child), bytemuck::bytes_of(&Child::NONE));
                    assert!(finite < 2, "{name}: a node with one child");
                }
                (0, false) => open.push((first, Some(child), depth + 1)),
                (count, _) => {
                    assert_eq!(count, 1, "{name}");
                    leaves[first] += 1;
                    let Corners { a, b, c } = built.corners[first];
                    let exact = box_of([a, b, c]).expect("a leaf's triangle is finite");
                    let found = seen((child.low, child.high));
                    assert_eq!(found, seen(exact), "{name}: position {first}");
                }
            }
        }
    }
    assert!(leaves[..finite].iter().all(|&times| times == 1), "{name}: {leaves:?}");
    assert!(leaves[finite..].iter().all(|&times| times == 0), "{name}: {leaves:?}");
    let used = finite.saturating_sub(1).max(1);
    assert!(reached[..used].iter().all(|&times| times == 1), "{name}: {reached:?}");
    assert!(reached[used..].iter().all(|&times| times == 0), "{name}: {reached:?}");
    assert!(deepest <= built.most_depth, "{name}: {deepest} nodes deep");
}

/// A box as a device may read it: numbers below 2^-126 may count as 0 (Vulkan specification, appendix "Vulkan
/// Environment for SPIR-V"). The software driver preserves them.
fn seen((low, high): (Vec3, Vec3)) -> [Vec3; 2] {
    let flushed = |x: f32| if x.is_subnormal() { 0.0 } else { x };
    [low, high].map(|corner| {
        if run::device::is_software() { corner } else { corner.to_array().map(flushed).into() }
    })
}
