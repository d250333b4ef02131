//! Input of the device: queries in its memory, and their shapes in a top level.

use anyhow::{Result, ensure};
use ash::vk;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu};
use common::scene::{boxes_on_gpu, build_top, input_usage};
use glam::{DVec3, Vec3};

use crate::ladder::Primitive;
use crate::query::{Answer, Query, Ray};
use crate::shape::{Shape, parts};

/// Queries in device memory, all of one primitive, and their shapes in a top level.
pub struct Batch {
    pub primitive: Primitive,
    pub count: u32,
    /// The length of the longest sum; 1 if there is none.
    pub samples: u32,
    pub queries: Buffer,
    pub numbers: Buffer,
    pub answers: Buffer,
    /// The shapes as boxes, and as the device's own triangles.
    pub boxes: Option<Level>,
    pub triangles: Option<Level>,
}

pub struct Level {
    pub tlas: AccelerationStructure,
    _levels: Vec<AccelerationStructure>,
    _inputs: Vec<Buffer>,
}

impl Batch {
    /// `asked` says which shape each ray is for; `is_traced`, whether they shall stand in a top level.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(
        gpu: &Gpu,
        shapes: &[Shape],
        asked: &[(usize, Ray)],
        is_traced: bool,
    ) -> Result<Self> {
        ensure!(!shapes.is_empty() && !asked.is_empty(), "nothing is asked");
        let primitive = shapes[0].primitive();
        let (mut queries, mut numbers) = (Vec::new(), Vec::new());
        let mut known: Vec<Option<(u32, Vec<f32>)>> = vec![None; shapes.len()];
        for &(shape, Ray { origin, direction, tmin, tmax }) in asked {
            let own = shapes[shape].numbers(origin);
            let count = own.len() as u32;
            // A mesh is the same for every ray; what the host prepares for a ray is not.
            let first = match &known[shape] {
                Some((first, known)) if *known == own => *first,
                _ => {
                    let first = numbers.len() as u32;
                    numbers.extend_from_slice(&own);
                    known[shape] = Some((first, own));
                    first
                }
            };
            let shape = shape as u32;
            queries.push(Query { origin, tmin, direction, tmax, first, count, shape });
        }
        let samples =
            shapes.iter().map(|shape| if let Shape::Sum(sum) = shape { sum.n } else { 1 });
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_SRC;
        let size = (queries.len() * size_of::<Answer>()) as u64;
        Ok(Self {
            primitive,
            count: queries.len() as u32,
            samples: samples.max().unwrap_or(1),
            queries: Buffer::with_data(gpu, "queries", &queries, input_usage())?,
            numbers: Buffer::with_data(gpu, "numbers", &numbers, input_usage())?,
            answers: Buffer::new(gpu, "answers", size, usage)?,
            boxes: is_traced.then(|| boxes(gpu, shapes, asked)).transpose()?,
            triangles: (is_traced && primitive == Primitive::Triangle)
                .then(|| triangles(gpu, shapes))
                .transpose()?,
        })
    }

    /// Number of queries.
    pub fn count(&self) -> u32 {
        self.count
    }
}

/// Each shape in a bottom level of its own, as one box. The box has a margin that grows with the
/// distance of its rays' origins: the device's box test rounds.
fn boxes(gpu: &Gpu, shapes: &[Shape], asked: &[(usize, Ray)]) -> Result<Level> {
    let mut reach = vec![0.0f64; shapes.len()];
    for &(index, ray) in asked {
        let (low, high) = shapes[index].bounds();
        let mut origin = ray.origin.as_dvec3();
        if let Shape::Instance(rows) = &shapes[index] {
            let (linear, translation) = parts(rows);
            // In the shape's space; and the way there rounds relative to the matrix's entries.
            let inverse = linear.inverse();
            let stray = |v: DVec3| {
                DVec3::from_array([0, 1, 2].map(|row| inverse.row(row).abs().dot(v.abs())))
            };
            origin = inverse * (origin - translation);
            origin = origin.abs() + stray(ray.origin.as_dvec3()) + stray(translation);
        }
        let near = origin.clamp(low, high);
        let size = (high - low).max_element().min(1e9);
        reach[index] = reach[index].max((origin - near).abs().max_element() + size);
    }
    let bottom = |(shape, reach): (&Shape, &f64)| -> Result<_> {
        let (low, high) = shape.bounds();
        // As in `common::gpu::padded`; an instance's matrix takes three products and their sum.
        let roundings = if matches!(shape, Shape::Instance(_)) { 18.0 } else { 10.0 };
        let coordinate = low.abs().max(high.abs());
        let margin = 2f64.powi(-24) * (DVec3::splat(roundings * reach) + 2.0 * coordinate);
        let corners = [down(low - margin), up(high + margin)];
        let input = boxes_on_gpu(gpu, "box", &[corners])?;
        let geometry = Geometry::Aabbs { boxes: input.address, count: 1, opaque: true };
        Ok((
            AccelerationStructure::bottom(gpu, "shape", &[geometry], BuildOptions::default())?,
            input,
        ))
    };
    let levels = shapes.iter().zip(&reach).map(bottom).collect::<Result<Vec<_>>>()?;
    level(gpu, shapes, levels)
}

fn triangles(gpu: &Gpu, shapes: &[Shape]) -> Result<Level> {
    let bottom = |shape: &Shape| -> Result<_> {
        let Shape::Triangles(mesh) = shape else { unreachable!("a batch has one primitive") };
        let count = mesh.len() as u32;
        let indices: Vec<u32> = (0..3 * count).collect();
        let size = 36 * mesh.len() as u64;
        let corners: Vec<u32> = mesh
            .as_flattened()
            .iter()
            .flat_map(|corner| corner.to_array().map(f32::to_bits))
            .chain(indices)
            .collect();
        let input = Buffer::with_data(gpu, "triangles", &corners, input_usage())?;
        let geometry = Geometry::Triangles {
            vertices: input.address,
            vertex_stride: 12,
            vertex_count: 3 * count,
            indices: input.address + size,
            count,
            opaque: false,
            no_duplicate_any_hit: false,
        };
        Ok((
            AccelerationStructure::bottom(gpu, "mesh", &[geometry], BuildOptions::default())?,
            input,
        ))
    };
    let levels = shapes.iter().map(bottom).collect::<Result<Vec<_>>>()?;
    level(gpu, shapes, levels)
}

/// A top level in which an instance's custom index is the number of its shape.
fn level(
    gpu: &Gpu,
    shapes: &[Shape],
    levels: Vec<(AccelerationStructure, Buffer)>,
) -> Result<Level> {
    let instance = |(index, (shape, (blas, _))): (usize, (&Shape, &(AccelerationStructure, _)))| {
        let rows = if let Shape::Instance(rows) = shape { rows } else { &IDENTITY };
        instance(rows, index as u32, blas.address)
    };
    let instances: Vec<_> = shapes.iter().zip(&levels).enumerate().map(instance).collect();
    let tlas = build_top(gpu, &instances)?;
    let (levels, inputs) = levels.into_iter().unzip();
    Ok(Level { tlas, _levels: levels, _inputs: inputs })
}

/// Three rows of four that leave everything where it is.
pub const IDENTITY: [[f32; 4]; 3] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// A bottom level in its place, of the only hit group.
pub fn instance(
    rows: &[[f32; 4]; 3],
    index: u32,
    blas: vk::DeviceAddress,
) -> vk::AccelerationStructureInstanceKHR {
    let mut matrix = [0.0; 12];
    matrix.copy_from_slice(rows.as_flattened());
    vk::AccelerationStructureInstanceKHR {
        transform: vk::TransformMatrixKHR { matrix },
        instance_custom_index_and_mask: vk::Packed24_8::new(index, 0xff),
        instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(0, 0),
        acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
            device_handle: blas,
        },
    }
}

/// Rounded to f32, but never up.
fn down(v: DVec3) -> Vec3 {
    v.to_array()
        .map(|x| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 })
        .into()
}

fn up(v: DVec3) -> Vec3 {
    -down(-v)
}
