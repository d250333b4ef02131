//! Trees built on the device, read back: every triangle once, boxes exact, and the hierarchy a plain one of the same
//! codes.

mod karras;
mod shapes;
mod times;

use std::sync::Arc;

use ash::vk::BufferUsageFlags as Usage;
use common::gpu::{Buffer, Gpu, GpuOptions, Requirements};
use common::scene::{Scene, Vertex};
use glam::{Vec2, Vec3};
use instruments::arithmetic::Arithmetic;
use karras::{NOT_FINITE, codes, hierarchy};
use own_tree::{Child, Corners, DeviceBuilder, DeviceTree, Node, Scratch, Triangles};
use shapes::Shape;

fn gpu(validate: bool, arithmetic: Arithmetic) -> Gpu {
    let (requirements, emulation) = (Requirements::ray_tracing(), Arc::new(arithmetic));
    Gpu::new(&GpuOptions { requirements, validate, emulation, ..GpuOptions::default() }).unwrap()
}

/// Triangles on the device, for a build.
struct Uploaded {
    vertices: Buffer,
    triangles: Buffer,
    count: u32,
}

impl Uploaded {
    fn new(gpu: &Gpu, shape: &Shape) -> Self {
        Self::with_usage(gpu, shape, Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS)
    }

    fn with_usage(gpu: &Gpu, shape: &Shape, usage: Usage) -> Self {
        let upload =
            |name: &str, words: &[u32]| Buffer::with_data(gpu, name, words, usage).unwrap();
        let vertices: Vec<Vertex> = shape.vertices.iter().map(|at| vertex(*at)).collect();
        Self {
            vertices: upload("vertices", bytemuck::cast_slice(&vertices)),
            triangles: upload("triangles", shape.triangles.as_flattened()),
            count: shape.triangles.len() as u32,
        }
    }

    fn input(&self) -> Triangles {
        let (vertices, triangles) = (self.vertices.address, self.triangles.address);
        Triangles { vertices, triangles, count: self.count }
    }
}

fn vertex(position: Vec3) -> Vertex {
    Vertex { position, normal: Vec3::Y, uv: Vec2::ZERO }
}

/// A tree that was built and read back.
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

/// What the tests of one device share.
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

    /// Builds a tree and holds all that is promised of it.
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

/// The least box around a triangle, if it is finite.
fn box_of(corners: [Vec3; 3]) -> Option<(Vec3, Vec3)> {
    let [a, b, c] = corners;
    corners.iter().all(|corner| corner.is_finite()).then(|| (a.min(b).min(c), a.max(b).max(c)))
}

/// Holds that each finite triangle lies in one leaf, that each node is reached once, and that boxes are exact.
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
    // Each node with the box that its parent has for it, and how many nodes lead to it, itself among them.
    let mut open: Vec<(usize, Option<Child>, u32)> = vec![(0, None, 1)];
    while let Some((index, of_parent, depth)) = open.pop() {
        reached[index] += 1;
        deepest = deepest.max(depth);
        let children = built.nodes[index].children;
        if let Some(expected) = of_parent {
            let low = children[0].low.min(children[1].low);
            let high = children[0].high.max(children[1].high);
            assert_eq!((expected.low, expected.high), (low, high), "{name}: node {index}");
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
                    assert_eq!((child.low, child.high), exact, "{name}: position {first}");
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

#[test]
fn every_triangle_is_in_one_leaf_and_every_box_is_exact_whatever_the_number() {
    let bench = Bench::new();
    for count in [0, 1, 2, 3, 4, 5, 7, 8, 9, 63, 64, 65, 100, 1000, 2048, 2049, 30_000] {
        bench.checked(&shapes::soup(count, count));
    }
}

#[test]
fn no_triangle_is_lost_in_any_order() {
    let bench = Bench::new();
    let mesh = shapes::cloth(40, 30);
    for shape in [mesh.clone(), mesh.clone().reversed(), mesh.shuffled(7)] {
        bench.checked(&shape);
    }
}

#[test]
fn every_mesh_of_the_chess_set_gets_its_tree() {
    let bench = Bench::new();
    for mesh in Scene::chess().unwrap().model.meshes {
        let vertices = mesh.vertices.iter().map(|vertex| vertex.position).collect();
        bench.checked(&Shape { name: mesh.name, vertices, triangles: mesh.triangles });
    }
}

#[test]
fn what_is_hard_to_sort_ends_in_bounded_depth() {
    let bench = Bench::new();
    let deep = |shape: &Shape| {
        let built = bench.checked(shape);
        depth(&built.nodes)
    };
    // Their codes are the same, so that their positions make a balanced tree: 2^17 are more.
    assert_eq!(deep(&shapes::in_one_place(100_000)), 17);
    assert_eq!(deep(&shapes::in_one_place(3)), 2);
    // Each at half the distance of the one before: the tree is a list, as long as there are bits, and then the same
    // once more.
    assert!(deep(&shapes::halving(1000)) <= 40);
    for scale in [1e9, 1e38, 1e-18, 1e-36] {
        bench.checked(&shapes::soup(500, 3).scaled(scale));
    }
    bench.checked(&shapes::flat(500));
    // In one direction all that floats have.
    bench.checked(&shapes::soup(500, 3).stretched(Vec3::new(3.4e38, 1.0, 1e-30)));
}

#[test]
fn triangles_that_are_not_finite_are_left_out_and_change_nothing_else() {
    let bench = Bench::new();
    let whole = shapes::soup(300, 11);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for step in [1, 2, 7, 299] {
            let mut shape = whole.clone();
            for triangle in shape.triangles.iter().step_by(step) {
                shape.vertices[triangle[step % 3] as usize][step % 3] = bad;
            }
            let built = bench.checked(&shape);
            let finite: Vec<[u32; 3]> = shape.triangles.iter().copied().collect();
            let finite: Vec<[u32; 3]> =
                finite.into_iter().filter(|t| box_of(shape.corners(*t)).is_some()).collect();
            let rest = Shape { triangles: finite, ..shape.clone() };
            let without = bench.checked(&rest);
            let used = without.nodes.len();
            assert_eq!(
                bytemuck::cast_slice::<_, u8>(&built.nodes[..used]),
                bytemuck::cast_slice::<_, u8>(&without.nodes)
            );
        }
    }
}

#[test]
fn the_hierarchy_is_that_of_a_plain_host_on_the_same_codes() {
    let bench = Bench::new();
    let mut broken = shapes::soup(3000, 5);
    broken.vertices[100].x = f32::NAN;
    for shape in [
        shapes::soup(2, 1),
        shapes::soup(3000, 2),
        shapes::cloth(50, 40).shuffled(3),
        shapes::in_one_place(1000),
        shapes::halving(200),
        broken,
    ] {
        let built = bench.checked(&shape);
        let codes = codes(&shape);
        let mut order: Vec<u32> = (0..codes.len() as u32).collect();
        order.sort_by_key(|&triangle| codes[triangle as usize]);
        assert_eq!(
            built.original, order,
            "{}: sorted, and the same ones in their order",
            shape.name
        );
        let keys = order.iter().map(|&triangle| codes[triangle as usize]);
        let keys: Vec<u32> = keys.filter(|&code| code != NOT_FINITE).collect();
        for (index, expected) in hierarchy(&keys).into_iter().enumerate() {
            let found = built.nodes[index].children.map(|child| (child.first, child.count == 1));
            assert_eq!(found, expected, "{}: node {index}", shape.name);
        }
    }
}

#[test]
fn the_same_triangles_give_the_same_bytes() {
    let bench = Bench::new();
    for shape in [shapes::soup(10_000, 9), shapes::in_one_place(5000)] {
        let first = bench.checked(&shape);
        for _ in 0..3 {
            assert_eq!(bench.checked(&shape).bytes(), first.bytes());
        }
    }
}

#[test]
fn a_refit_fits_what_has_moved_and_leaves_the_shape() {
    let bench = Bench::new();
    let still = shapes::cloth(60, 40);
    let mut moved = still.clone();
    for at in &mut moved.vertices {
        at.z = (3.0 * at.x + at.y).sin();
    }
    let (tree, input) = bench.build(&still);
    let before = Built::read(&tree);
    let vertices: Vec<Vertex> = moved.vertices.iter().map(|at| vertex(*at)).collect();
    input.vertices.write(0, &vertices).unwrap();
    let refit = |cmd| bench.builder.refit(cmd, input.input(), &tree, &bench.scratch);
    bench.gpu.submit(refit).unwrap();
    let after = Built::read(&tree);
    check(&moved, &after);
    assert_eq!(before.original, after.original);
    for (before, after) in before.nodes.iter().zip(&after.nodes) {
        let shape = |node: &Node| node.children.map(|child| (child.first, child.count));
        assert_eq!(shape(before), shape(after));
    }
    bench.is_silent();
}

#[test]
fn a_triangle_that_ceases_to_be_finite_is_in_no_box_after_a_refit() {
    let bench = Bench::new();
    let mut shape = shapes::soup(200, 4);
    let (tree, input) = bench.build(&shape);
    let gone = shape.triangles[17];
    shape.vertices[gone[1] as usize].y = f32::NAN;
    let vertices: Vec<Vertex> = shape.vertices.iter().map(|at| vertex(*at)).collect();
    input.vertices.write(0, &vertices).unwrap();
    let refit = |cmd| bench.builder.refit(cmd, input.input(), &tree, &bench.scratch);
    bench.gpu.submit(refit).unwrap();
    let built = Built::read(&tree);
    let children = built.nodes.iter().flat_map(|node| node.children);
    for child in children {
        match child.count {
            1 if built.original[child.first as usize] == 17 => {
                assert_eq!((child.low, child.high), (Child::NONE.low, Child::NONE.high));
            }
            _ => assert!(child.low.is_finite() && child.high.is_finite()),
        }
    }
    bench.is_silent();
}

#[test]
fn builds_and_refits_in_one_submission_wait_for_each_other() {
    let bench = Bench::new();
    let shapes = [shapes::soup(3000, 21), shapes::cloth(30, 30), shapes::soup(900, 22)];
    let inputs: Vec<_> = shapes.iter().map(|shape| Uploaded::new(&bench.gpu, shape)).collect();
    let trees = inputs.iter().map(|input| DeviceTree::new(&bench.gpu, input.count).unwrap());
    let trees: Vec<_> = trees.collect();
    bench
        .gpu
        .submit(|cmd| {
            for (input, tree) in inputs.iter().zip(&trees) {
                bench.builder.record(cmd, input.input(), tree, &bench.scratch)?;
            }
            bench.builder.refit(cmd, inputs[0].input(), &trees[0], &bench.scratch)
        })
        .unwrap();
    for (shape, tree) in shapes.iter().zip(&trees) {
        check(shape, &Built::read(tree));
    }
    bench.is_silent();
}

#[test]
fn boxes_are_exact_in_the_worst_arithmetic() {
    if !run::has_worst_arithmetic() {
        return;
    }
    let bench = Bench::with(Arithmetic::WorstByPlace);
    let mut broken = shapes::soup(500, 8);
    broken.vertices[100].x = f32::NAN;
    for shape in [shapes::soup(3000, 2), shapes::cloth(30, 20), shapes::halving(300), broken] {
        bench.checked(&shape);
    }
    bench.checked(&shapes::soup(500, 3).scaled(1e9));
}

#[test]
#[ignore = "by hand: takes 2 GB of memory"]
fn more_triangles_than_one_row_of_workgroups_has_invocations_for() {
    let (bench, count) = (Bench::new(), 65_535 * 64 + 1000);
    let scratch = Scratch::new(&bench.gpu, count).unwrap();
    Bench { scratch, ..bench }.checked(&shapes::soup(count, 1));
}

#[test]
fn what_does_not_fit_is_refused_in_one_line() {
    let bench = Bench::new();
    let input = Uploaded::new(&bench.gpu, &shapes::soup(10, 1));
    let scratch = Scratch::new(&bench.gpu, 9).unwrap();
    let refused = |tree: &DeviceTree, scratch: &Scratch| {
        let record = |cmd| bench.builder.record(cmd, input.input(), tree, scratch);
        bench.gpu.submit(record).unwrap_err().to_string()
    };
    let [ten, eleven] = [10, 11].map(|count| DeviceTree::new(&bench.gpu, count).unwrap());
    assert_eq!(refused(&eleven, &bench.scratch), "a tree of 11 triangles cannot be built from 10");
    assert_eq!(
        refused(&ten, &scratch),
        "scratch memory for 9 triangles is too small for a tree of 10"
    );
    let error = DeviceTree::new(&bench.gpu, 1 << 30).err().unwrap().to_string();
    assert!(error.starts_with("1073741824 triangles are too many"), "{error}");
}

/// How many nodes the longest path from the root has.
fn depth(nodes: &[Node]) -> u32 {
    let mut open = vec![(0, 1)];
    let mut deepest = 0;
    while let Some((index, depth)) = open.pop() {
        deepest = deepest.max(depth);
        for child in nodes[index as usize].children {
            if child.count == 0 && child.low.x <= child.high.x {
                open.push((child.first, depth + 1));
            }
        }
    }
    deepest
}
