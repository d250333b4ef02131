//! A device's freedom with boxes: it may call the intersection shader for rays that miss them, and in any
//! order.

use common::gpu::{
    AccelerationStructure, Address, Binding, Buffer, BuildOptions, Descriptor, Geometry, Gpu,
    HitGroup, RayTracingPipeline, ShaderBindingTable, barrier, order,
};
use common::scene::{boxes_on_gpu, build_top, input_usage, instance_on_gpu};
use glam::{Affine3A, Vec3};

common::shader_struct! {
    struct Push {
        offered: Address,
    }
}

/// Maximum number of recorded calls of the shader, as in boxes.glsl.
const MOST: usize = 7;
const RAYS: u32 = 8;

/// For each ray, the numbers of the boxes for which the intersection shader was called.
fn offered(gpu: &Gpu, boxes: &[[Vec3; 2]]) -> Vec<Vec<u32>> {
    let bounds: Vec<order::Bounds> = boxes.iter().map(|&[low, high]| (low, high)).collect();
    let order = order::for_build(gpu, &bounds, false);
    let ordered: Vec<[Vec3; 2]> = order.iter().map(|&i| boxes[i as usize]).collect();
    let input = boxes_on_gpu(gpu, "boxes", &ordered).unwrap();
    let count = boxes.len() as u32;
    let geometry = Geometry::Aabbs { boxes: input.address, count, opaque: true };
    let options = BuildOptions::default();
    let level = AccelerationStructure::bottom(gpu, "boxes", &[geometry], options).unwrap();
    let tlas = build_top(gpu, &[instance_on_gpu(&Affine3A::IDENTITY, 0, 0, &level)]).unwrap();
    let pipeline = RayTracingPipeline::builder("operations")
        .raygen("boxes.rgen")
        .miss("boxes.rmiss")
        .hit(HitGroup::procedural("boxes.rint"))
        .binding(Binding::AccelerationStructure)
        .push_constants::<Push>()
        .build(gpu)
        .unwrap();
    let sbt = ShaderBindingTable::new(gpu, &pipeline).unwrap();
    let usage = input_usage() | ash::vk::BufferUsageFlags::TRANSFER_SRC;
    let size = u64::from(RAYS) * 4 * (1 + MOST as u64);
    let output = Buffer::new(gpu, "offered", size, usage).unwrap();
    let push = Push { offered: output.address.into() };
    let extent = ash::vk::Extent2D { width: RAYS, height: 1 };
    gpu.submit(|cmd| {
        pipeline.bind(cmd, &[Descriptor::AccelerationStructure(&tlas)], &push)?;
        sbt.trace(cmd, extent.into());
        barrier::trace_to_trace(gpu, cmd);
        Ok(())
    })
    .unwrap();
    let found: Vec<[u32; 1 + MOST]> = output.read().unwrap();
    let numbers = |[count, places @ ..]: &[u32; 1 + MOST]| {
        let places = places[..*count as usize].iter();
        places.map(|&place| order[place as usize]).collect()
    };
    found.iter().map(numbers).collect()
}

/// Rays along z at x = 0, 1, 2, ...; the second device has the worst arithmetic.
pub fn offers_more_boxes_in_another_order(driver: &Gpu, worst: &Gpu) {
    // From x = 1.5 to 3.5, so rays 2 and 3 hit it. At twice the size, so do rays 1 and 4.
    let one = [Vec3::new(1.5, -1.0, -1.0), Vec3::new(3.5, 1.0, 1.0)];
    let met = |gpu| -> Vec<usize> { offered(gpu, &[one]).iter().map(Vec::len).collect() };
    assert_eq!(met(driver), [0, 0, 1, 1, 0, 0, 0, 0]);
    assert_eq!(met(worst), [0, 1, 1, 1, 1, 0, 0, 0]);
    // Flat boxes get some thickness.
    let flat = [Vec3::new(2.0, -1.2, 0.0), Vec3::new(2.0, 1.2, 0.0)];
    let met = |gpu| -> Vec<usize> { offered(gpu, &[flat]).iter().map(Vec::len).collect() };
    assert_eq!(met(worst), [0, 1, 1, 1, 0, 0, 0, 0]);
    // All in the same place: only the order of the build distinguishes them.
    let calls = |gpu| offered(gpu, &[one; 5])[2].clone();
    let (one_way, other_way) = (calls(driver), calls(worst));
    assert_eq!((one_way.len(), other_way.len()), (5, 5), "{one_way:?} {other_way:?}");
    let turned: Vec<u32> = other_way.into_iter().rev().collect();
    assert_eq!(one_way, turned);
}
