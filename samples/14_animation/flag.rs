//! A flag: a compute shader moves its vertices, and its bottom level follows.

use anyhow::Result;
use ash::vk;
use common::Playback;
use common::gpu::{Address, Buffer, ComputePipeline, Geometry, Gpu, barrier};
use common::scene::{InstanceRecord, Mesh, SceneOptions, Vertex, input_usage, triangle_order};
use glam::{UVec2, Vec2, Vec3};

/// Width and height of the cloth.
pub const SIZE: Vec2 = Vec2::new(4.2, 2.6);

common::shader_struct! {
    /// Push constants of the compute shader.
    struct Cloth {
        vertices: Address<Vertex>,
        /// Cells of the cloth, across and down.
        cells: UVec2,
        size: Vec2,
        /// Swing to either side, in radians.
        swing: f32,
        /// The part of a wave that has passed the pole, 0 to 1.
        phase: f32,
    }
}

/// The flag on the device.
pub struct Flag {
    /// Number of cells across; down they are two thirds as many.
    pub across: u32,
    /// The record of its instance, whose material is still to be filled in.
    pub record: InstanceRecord,
    cells: UVec2,
    vertices: Buffer,
    /// Triangles in the order of the build.
    ordered: Buffer,
    count: u32,
    pipeline: ComputePipeline,
    gpu: Gpu,
    _buffers: [Buffer; 2],
}

impl Flag {
    pub fn new(gpu: &Gpu, across: u32, options: SceneOptions) -> Result<Self> {
        let cells = UVec2::new(across, (2 * across).div_ceil(3));
        let mesh = flat(cells);
        let order = triangle_order(gpu, &mesh, options);
        let ordered: Vec<_> = order.iter().map(|&i| mesh.triangles[i as usize]).collect();
        let upload = |name: &str, words: &[u32]| Buffer::with_data(gpu, name, words, input_usage());
        let vertices = Buffer::with_data(gpu, "flag", &mesh.vertices, input_usage())?;
        let triangles = upload("flag triangles", mesh.triangles.as_flattened())?;
        let original = upload("flag order", &order)?;
        let record = InstanceRecord {
            vertices: vertices.address.into(),
            triangles: triangles.address.into(),
            original: original.address.into(),
            material: 0,
            mesh: 0,
        };
        let count = ordered.len() as u32;
        let ordered = upload("flag build order", ordered.as_flattened())?;
        let (pipeline, gpu, _buffers) = (pipeline(gpu)?, gpu.clone(), [triangles, original]);
        Ok(Self { across, record, cells, vertices, ordered, count, pipeline, gpu, _buffers })
    }

    /// The geometry of its bottom level: the addresses stay the same, whatever is stored there.
    pub fn geometry(&self) -> Geometry {
        Geometry::Triangles {
            vertices: self.vertices.address,
            vertex_stride: size_of::<Vertex>() as u64,
            vertex_count: (self.cells.x + 1) * (self.cells.y + 1),
            indices: self.ordered.address,
            count: self.count,
            opaque: true,
            no_duplicate_any_hit: false,
        }
    }

    /// Moves the vertices to where they are at a frame.
    pub fn deform(&self, cmd: vk::CommandBuffer, frame: u32) -> Result<()> {
        let [swing, phase] = wind(frame);
        let vertices = self.vertices.address.into();
        let push = Cloth { vertices, cells: self.cells, size: SIZE, swing, phase };
        let extent = vk::Extent2D { width: self.cells.x + 1, height: self.cells.y + 1 };
        barrier::trace_to_deform(&self.gpu, cmd);
        self.pipeline.bind(cmd, &[], &push)?;
        self.pipeline.dispatch(cmd, vk::Rect2D { extent, ..Default::default() });
        barrier::deform_to_build(&self.gpu, cmd);
        Ok(())
    }
}

/// The box that the cloth never leaves, about the pole's top.
pub fn bounds() -> (Vec3, Vec3) {
    (Vec3::new(-0.5 * SIZE.x, -1.25 * SIZE.y, -SIZE.x), Vec3::new(SIZE.x, 0.1, SIZE.x))
}

/// The swing of the cloth at a frame, and the phase of its waves: in 64 bits, so that the last frame of a long game
/// is as exact as the first.
fn wind(frame: u32) -> [f32; 2] {
    let seconds = f64::from(frame) / f64::from(Playback::RATE);
    let gust = 0.8 + 0.25 * (1.3 * seconds).sin();
    // In the first four seconds it unfolds.
    let open = (seconds / 4.0).min(1.0);
    let open = open * open * (3.0 - 2.0 * open);
    [(1.9 + (gust - 1.9) * open) as f32, (0.9 * seconds).fract() as f32]
}

/// The cloth without wind: it hangs in a plane from its pole, two triangles a cell.
fn flat(cells: UVec2) -> Mesh {
    let corner = |x: u32, y: u32| y * (cells.x + 1) + x;
    let corners = (0..=cells.y).flat_map(|y| (0..=cells.x).map(move |x| UVec2::new(x, y)));
    let vertices = corners.map(|at| {
        let uv = at.as_vec2() / cells.as_vec2();
        let position = (uv * SIZE * Vec2::new(1.0, -1.0)).extend(0.0);
        Vertex { position, normal: Vec3::Z, uv }
    });
    let cells = (0..cells.y).flat_map(|y| (0..cells.x).map(move |x| (x, y)));
    let triangles = cells.flat_map(|(x, y)| {
        let [a, b, c, d] = [corner(x, y), corner(x, y + 1), corner(x + 1, y + 1), corner(x + 1, y)];
        [[a, b, c], [a, c, d]]
    });
    let (vertices, triangles) = (vertices.collect(), triangles.collect());
    Mesh { name: "flag".to_owned(), vertices, triangles, material: 0 }
}

fn pipeline(gpu: &Gpu) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("flag.comp")
        .workgroup(0, [8, 8])
        .push_constants::<Cloth>()
        .build_compute(gpu)
}
