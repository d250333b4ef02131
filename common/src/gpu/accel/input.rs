//! The input of a build, compared with the arrays it is read from: a driver takes addresses on trust.

use anyhow::{Result, bail, ensure};
use ash::vk;
use bytemuck::Pod;

use crate::gpu::memory::arrays::Array;
use crate::gpu::memory::staging::read_back;
use crate::gpu::{Geometry, Gpu, barrier};

/// Bytes of a position, a triangle's indices, a box and an instance.
const POSITION: u64 = 12;
const TRIANGLE: u64 = 12;
const BOX: u64 = 24;
const INSTANCE: u64 = 64;

/// A part of the input: how many of what, the address, and the bytes a build reads there.
type Read = (u32, &'static str, vk::DeviceAddress, u64);

/// Checks that everything a build reads is in existing arrays.
///
/// # Errors
/// Names the geometry of `name`, what is wrong, and what would be right.
pub(super) fn check_arrays(gpu: &Gpu, name: &str, geometries: &[Geometry]) -> Result<()> {
    for (index, geometry) in geometries.iter().enumerate() {
        let of = format!("geometry {index} of '{name}'");
        stride(&of, geometry)?;
        for (count, what, address, bytes) in reads(geometry) {
            let array = gpu.arrays().from(address);
            let Some(array) = array else {
                bail!("{of}: no buffer has its {what}, at {address:#x}; was it dropped?")
            };
            ensure!(
                array.bytes >= bytes,
                "{of}: {count} {what} take {bytes} bytes, and the buffer '{}' has {} from there on",
                array.name,
                array.bytes
            );
        }
    }
    Ok(())
}

/// Reads arrays back, and checks that each index names a vertex and each box has its low corner below its high one.
///
/// # Errors
/// As [`check_arrays`].
pub(super) fn check_contents(gpu: &Gpu, name: &str, geometries: &[Geometry]) -> Result<()> {
    for (index, geometry) in geometries.iter().enumerate() {
        let of = format!("geometry {index} of '{name}'");
        match *geometry {
            Geometry::Triangles { vertex_count, indices, count, .. } => {
                indices_within(&of, vertex_count, &read(gpu, indices, count)?)?;
            }
            Geometry::Aabbs { boxes, count, .. } => boxes_upright(&of, &read(gpu, boxes, count)?)?,
            Geometry::Instances { .. } => {}
        }
    }
    Ok(())
}

/// Checks the distance from one vertex to the next.
fn stride(of: &str, geometry: &Geometry) -> Result<()> {
    if let Geometry::Triangles { vertex_stride, .. } = geometry {
        ensure!(
            *vertex_stride >= POSITION && vertex_stride.is_multiple_of(4),
            "{of}: a vertex_stride of {vertex_stride} bytes; a position takes {POSITION}, and the stride is a \
             multiple of 4: size_of::<Vertex>(), where vertices are of that type"
        );
    }
    Ok(())
}

/// Everything a build of a geometry reads; nothing if it has no primitives.
fn reads(geometry: &Geometry) -> Vec<Read> {
    if geometry.count() == 0 {
        return Vec::new();
    }
    match *geometry {
        Geometry::Triangles { vertices, vertex_stride, vertex_count, indices, count, .. } => {
            let last = u64::from(vertex_count.saturating_sub(1)) * vertex_stride;
            let positions = if vertex_count > 0 { last + POSITION } else { 0 };
            vec![
                (vertex_count, "vertices", vertices, positions),
                (count, "triangles", indices, u64::from(count) * TRIANGLE),
            ]
        }
        Geometry::Aabbs { boxes, count, .. } => {
            vec![(count, "boxes", boxes, u64::from(count) * BOX)]
        }
        Geometry::Instances { instances, count } => {
            vec![(count, "instances", instances, u64::from(count) * INSTANCE)]
        }
    }
}

fn indices_within(of: &str, vertex_count: u32, triangles: &[[u32; 3]]) -> Result<()> {
    for (number, triangle) in triangles.iter().enumerate() {
        let beyond = triangle.iter().find(|index| **index >= vertex_count);
        if let Some(index) = beyond {
            bail!(
                "{of}: triangle {number} has the index {index}, and there are {vertex_count} vertices, counted \
                 from 0"
            );
        }
    }
    Ok(())
}

/// A NaN is in order: such a box is inactive.
fn boxes_upright(of: &str, boxes: &[[f32; 6]]) -> Result<()> {
    for (number, corners) in boxes.iter().enumerate() {
        let (low, high) = corners.split_at(3);
        let turned = (0..3).find(|&axis| low[axis] > high[axis]);
        if let Some(axis) = turned {
            let axis_name = ["x", "y", "z"][axis];
            bail!("{of}: box {number} has its low corner above its high one in {axis_name}");
        }
    }
    Ok(())
}

/// The first `count` elements of an array.
fn read<T: Pod>(gpu: &Gpu, address: vk::DeviceAddress, count: u32) -> Result<Vec<T>> {
    let array = gpu.arrays().from(address);
    let Some(Array { buffer, offset, .. }) = array.filter(|_| count > 0) else {
        return Ok(Vec::new());
    };
    let size = u64::from(count) * size_of::<T>() as u64;
    let mut copy = read_back(gpu, "input of a build", size, |cmd, to| {
        let region = vk::BufferCopy::default().src_offset(offset).size(size);
        barrier::before_readback(gpu, cmd);
        // SAFETY: the array is in a buffer that exists and is at least this long, as `check_arrays` has found; the
        // submission is waited for.
        unsafe { gpu.device.cmd_copy_buffer(cmd, buffer, to, &[region]) };
    })?;
    Ok(bytemuck::pod_collect_to_vec(copy.mapped_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{AccelerationStructure, Buffer, BuildOptions, GpuOptions, Requirements};
    use crate::scene::{boxes_on_gpu, input_usage};
    use glam::Vec3;

    fn gpu(validate: bool) -> Gpu {
        let requirements = Requirements::ray_tracing();
        Gpu::new(&GpuOptions { requirements, validate, ..GpuOptions::default() }).unwrap()
    }

    fn built(gpu: &Gpu, geometry: Geometry) -> Result<AccelerationStructure> {
        AccelerationStructure::bottom(gpu, "shape", &[geometry], BuildOptions::default())
    }

    fn line(gpu: &Gpu, geometry: Geometry) -> String {
        built(gpu, geometry).err().expect("it is refused").to_string()
    }

    /// Three corners and the indices of one triangle, 32 bytes apart and 12.
    fn triangle(gpu: &Gpu, index: u32) -> [Buffer; 2] {
        let corners = [[0f32; 8], [1.0; 8], [0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]];
        let usage = input_usage();
        [
            Buffer::with_data(gpu, "corners", &corners, usage).unwrap(),
            Buffer::with_data(gpu, "corner numbers", &[[0, 1, index]], usage).unwrap(),
        ]
    }

    fn of(
        [corners, numbers]: &[Buffer; 2],
        stride: u64,
        vertex_count: u32,
        count: u32,
    ) -> Geometry {
        Geometry::Triangles {
            vertices: corners.address,
            vertex_stride: stride,
            vertex_count,
            indices: numbers.address,
            count,
            opaque: true,
            no_duplicate_any_hit: false,
        }
    }

    #[test]
    fn what_lies_beyond_a_buffer_is_not_built() {
        let gpu = gpu(false);
        let boxes = boxes_on_gpu(&gpu, "cone", &[[Vec3::NEG_ONE, Vec3::ONE]]).unwrap();
        let boxes_of = |address, count| Geometry::Aabbs { boxes: address, count, opaque: true };
        built(&gpu, boxes_of(boxes.address, 1)).unwrap();
        assert_eq!(
            line(&gpu, boxes_of(boxes.address, 3)),
            "geometry 0 of 'shape': 3 boxes take 72 bytes, and the buffer 'cone' has 24 from there on"
        );
        let gone = boxes.address;
        drop(boxes);
        assert!(line(&gpu, boxes_of(gone, 1)).contains("no buffer has its boxes, at 0x"));
        assert!(line(&gpu, boxes_of(0, 1)).contains("no buffer has its boxes, at 0x0"));

        let parts = triangle(&gpu, 2);
        built(&gpu, of(&parts, 32, 3, 1)).unwrap();
        for stride in [0, 8, 14] {
            let said = line(&gpu, of(&parts, stride, 3, 1));
            assert!(
                said.contains(&format!("a vertex_stride of {stride} bytes; a position")),
                "{said}"
            );
        }
        let said = line(&gpu, of(&parts, 32, 4, 1));
        assert!(
            said.contains("4 vertices take 108 bytes, and the buffer 'corners' has 96"),
            "{said}"
        );
        let said = line(&gpu, of(&parts, 32, 3, 50));
        assert!(
            said.contains("50 triangles take 600 bytes, and the buffer 'corner numbers' has 12"),
            "{said}"
        );
        let top = AccelerationStructure::top(&gpu, "top", &parts[0], 2, BuildOptions::default());
        assert!(top.err().unwrap().to_string().contains("2 instances take 128 bytes"));
    }

    #[test]
    fn arrays_in_one_buffer_do_not_run_into_each_other() {
        let gpu = gpu(false);
        let arrays = [[[0f32; 6]; 2].to_vec(), [[1f32; 6]; 9].to_vec()];
        let (_boxes, at) = Buffer::with_arrays(&gpu, "all", arrays, input_usage()).unwrap();
        let boxes_of = |boxes, count| Geometry::Aabbs { boxes, count, opaque: true };
        built(&gpu, boxes_of(at[0], 2)).unwrap();
        built(&gpu, boxes_of(at[1] + 24, 8)).unwrap();
        assert!(
            line(&gpu, boxes_of(at[0], 3))
                .contains("3 boxes take 72 bytes, and the buffer 'all' has 48")
        );
        assert!(line(&gpu, boxes_of(at[1] + 24, 9)).contains("has 192 from there on"));
    }

    #[test]
    fn validation_looks_at_indices_and_boxes() {
        let gpu = gpu(true);
        built(&gpu, of(&triangle(&gpu, 2), 32, 3, 1)).unwrap();
        assert_eq!(
            line(&gpu, of(&triangle(&gpu, 100), 32, 3, 1)),
            "geometry 0 of 'shape': triangle 0 has the index 100, and there are 3 vertices, counted from 0"
        );
        let turned = [[0f32, 0.0, 0.0, 1.0, 1.0, 1.0], [0.0, 5.0, 0.0, 1.0, 1.0, 1.0]];
        let boxes = Buffer::with_data(&gpu, "boxes", &turned, input_usage()).unwrap();
        assert_eq!(
            line(&gpu, Geometry::Aabbs { boxes: boxes.address, count: 2, opaque: true }),
            "geometry 0 of 'shape': box 1 has its low corner above its high one in y"
        );
    }
}
