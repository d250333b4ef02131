//! The scene of the atlas: a mesh or boxes in one bottom level, in one place of a top level.

use anyhow::Result;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu};
use common::scene::{boxes_on_gpu, build_top, input_usage};
use glam::Vec3;

use super::tracer::NOTHING;
use crate::batch::{IDENTITY, instance};

/// Three corners, as a build gets them.
pub type Corners = [Vec3; 3];

/// Three rows of four: a shape's space to the world's.
pub type Rows = [[f32; 4]; 3];

/// The test that determines the hit of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Traversal {
    /// The device.
    Device,
    /// An intersection shader of two-floats, nearly exact: what the atlas itself is tested with.
    Software,
}

impl Traversal {
    /// As the command line has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Device => "device",
            Self::Software => "software",
        }
    }
}

/// The build of a mesh.
#[derive(Clone, Copy, Default)]
pub struct Build {
    /// `VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR`.
    pub no_duplicates: bool,
    /// `VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DATA_ACCESS_KHR`.
    pub data_access: bool,
}

/// A top level, and which shape each primitive of its build is: a device that is emulated gets them in another
/// order, and some of them twice.
pub struct World {
    pub tlas: AccelerationStructure,
    /// The corners of each primitive, where a shader finds them.
    pub corners: Buffer,
    original: Vec<u32>,
    _blas: AccelerationStructure,
    _input: Buffer,
}

impl World {
    /// Triangles in their place.
    ///
    /// # Errors
    /// If memory is short.
    pub fn of_triangles(
        gpu: &Gpu,
        traversal: Traversal,
        triangles: &[Corners],
        rows: &Rows,
        build: Build,
    ) -> Result<Self> {
        let mut original = gpu.driver_shim.order((0..triangles.len() as u32).collect());
        if !build.no_duplicates {
            original = gpu.driver_shim.candidates(original);
        }
        let built: Vec<Corners> = original.iter().map(|&i| triangles[i as usize]).collect();
        let (input, geometry) = match traversal {
            Traversal::Device => device_triangles(gpu, &built, build.no_duplicates)?,
            Traversal::Software => boxes_of(gpu, &built.iter().map(around).collect::<Vec<_>>())?,
        };
        Self::new(gpu, input, geometry, &built, original, rows, build)
    }

    /// Boxes, each its low and its high corner, where they are.
    ///
    /// # Errors
    /// If memory is short.
    pub fn of_boxes(gpu: &Gpu, boxes: &[[Vec3; 2]]) -> Result<Self> {
        let original = gpu.driver_shim.order((0..boxes.len() as u32).collect());
        let built: Vec<_> = original.iter().map(|&i| boxes[i as usize]).collect();
        let (input, geometry) = boxes_of(gpu, &built)?;
        Self::new(gpu, input, geometry, &[], original, &IDENTITY, Build::default())
    }

    fn new(
        gpu: &Gpu,
        input: Buffer,
        geometry: Geometry,
        corners: &[Corners],
        original: Vec<u32>,
        rows: &Rows,
        build: Build,
    ) -> Result<Self> {
        let options = BuildOptions { data_access: build.data_access, ..BuildOptions::default() };
        let blas = AccelerationStructure::bottom(gpu, "atlas", &[geometry], options)?;
        let tlas = build_top(gpu, &[instance(rows, 0, blas.address)])?;
        let corners = Buffer::with_data(gpu, "corners", corners, input_usage())?;
        Ok(Self { tlas, corners, original, _blas: blas, _input: input })
    }

    /// The shape of a primitive of the build; [`NOTHING`] for one that does not exist.
    pub fn shape(&self, primitive: u32) -> u32 {
        self.original.get(primitive as usize).copied().unwrap_or(NOTHING)
    }
}

fn device_triangles(
    gpu: &Gpu,
    triangles: &[Corners],
    no_duplicate_any_hit: bool,
) -> Result<(Buffer, Geometry)> {
    let count = triangles.len() as u32;
    let indices: Vec<u32> = (0..3 * count).collect();
    let corners: Vec<u32> =
        triangles.iter().flatten().flat_map(|corner| corner.to_array().map(f32::to_bits)).collect();
    let arrays = [corners, indices];
    let (input, at) = Buffer::with_arrays(gpu, "triangles", arrays, input_usage())?;
    let geometry = Geometry::Triangles {
        vertices: at[0],
        vertex_stride: 12,
        vertex_count: 3 * count,
        indices: at[1],
        count,
        opaque: false,
        no_duplicate_any_hit,
    };
    Ok((input, geometry))
}

fn boxes_of(gpu: &Gpu, boxes: &[[Vec3; 2]]) -> Result<(Buffer, Geometry)> {
    let input = boxes_on_gpu(gpu, "boxes", boxes)?;
    let geometry =
        Geometry::Aabbs { boxes: input.address, count: boxes.len() as u32, opaque: false };
    Ok((input, geometry))
}

/// A box around a triangle, so much larger that no device's box test loses a ray that the atlas sends.
fn around(&[a, b, c]: &Corners) -> [Vec3; 2] {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let margin =
        Vec3::splat(0.25 * (high - low).max_element().max(0.01 * high.abs().max_element()));
    [low - margin, high + margin]
}
