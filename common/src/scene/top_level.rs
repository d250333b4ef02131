//! The top level: instances, checked before a device reads them.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use anyhow::{Context, Result, ensure};
use ash::vk;
use glam::DVec3;

use super::upload::{input_usage, instance_bytes};
use crate::gpu::{AccelerationStructure, Asked, AskedRecord, Buffer, BuildOptions, Gpu};

/// Builds a top level from instances already in the order of the build.
///
/// ```no_run
/// use raybook::prelude::*;
///
/// /// The meshes of a scene, and a shape of one's own whose hit group is the second.
/// fn everything(
///     gpu: &Gpu,
///     scene: &Scene,
///     meshes: &SceneOnGpu,
///     shape: &AccelerationStructure,
/// ) -> Result<AccelerationStructure> {
///     let placed = scene.instances.iter().enumerate();
///     let placed = placed
///         .map(|(i, at)| instance_on_gpu(&at.transform, i, 0, &meshes.blas[at.mesh]));
///     let own = instance_on_gpu(&Affine3A::IDENTITY, scene.instances.len(), 1, shape);
///     build_top(gpu, &placed.chain([own]).collect::<Vec<_>>())
/// }
/// ```
///
/// The top level keeps the bottom levels alive.
///
/// # Errors
/// If an instance has a transform that is not finite or not invertible, or refers to a bottom level that no longer
/// exists; if memory is short.
pub fn build_top(
    gpu: &Gpu,
    instances: &[vk::AccelerationStructureInstanceKHR],
) -> Result<AccelerationStructure> {
    build(gpu, instances, BuildOptions::default())
}

/// As [`build_top`], for a top level that [`AccelerationStructure::update`] may change.
///
/// # Errors
/// As [`build_top`].
pub fn build_updatable_top(
    gpu: &Gpu,
    instances: &[vk::AccelerationStructureInstanceKHR],
) -> Result<AccelerationStructure> {
    build(gpu, instances, BuildOptions { updatable: true, ..BuildOptions::default() })
}

fn build(
    gpu: &Gpu,
    instances: &[vk::AccelerationStructureInstanceKHR],
    options: BuildOptions,
) -> Result<AccelerationStructure> {
    let hidden =
        instances.iter().filter(|i| i.instance_custom_index_and_mask.high_8() == 0).count();
    let line =
        format!("{hidden} of {} instances have the mask 0: no ray sees them", instances.len());
    gpu.warn("top level", if hidden > 0 { vec![line] } else { Vec::new() });
    let mut below = BTreeMap::new();
    let mut asked = Asked::new();
    for (index, instance) in instances.iter().enumerate() {
        let place = || {
            let custom = instance.instance_custom_index_and_mask.low_24();
            format!("instance {index} of the top level, with the custom index {custom}")
        };
        check_matrix(&instance.transform.matrix).with_context(place)?;
        // SAFETY: the instances of a build on the device name bottom levels by address.
        let address = unsafe { instance.acceleration_structure_reference.device_handle };
        // Vulkan: such an instance is inactive.
        if address == 0 {
            continue;
        }
        let level = match below.entry(address) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let level = gpu.level_at(address).with_context(|| {
                    format!("{}: its bottom level, at {address:#x}, was dropped before", place())
                })?;
                new.insert(level)
            }
        };
        // An instance with a partial mask may be hidden because it has no hit group.
        let is_seen = instance.instance_custom_index_and_mask.high_8() == 0xff;
        let (kind, geometries) = level.geometries;
        let kind = kind.filter(|_| is_seen);
        let record = instance.instance_shader_binding_table_record_offset_and_flags.low_24();
        let record = AskedRecord { record, kind, geometries };
        asked.entry(record).or_insert_with(|| level.name.clone());
    }
    let bytes: Vec<_> = instances.iter().map(instance_bytes).collect();
    let buffer = Buffer::with_data(gpu, "instances", &bytes, input_usage())?;
    let count = instances.len() as u32;
    let mut top = AccelerationStructure::top(gpu, "top level", &buffer, count, options)?;
    gpu.note_asked(&asked);
    top.asked = asked;
    top.keep(below.into_values().collect());
    Ok(top)
}

/// Checks a transform in Vulkan's form.
fn check_matrix(rows: &[f32; 12]) -> Result<()> {
    let column = |i: usize| DVec3::new(rows[i].into(), rows[4 + i].into(), rows[8 + i].into());
    check_transform([column(0), column(1), column(2)], column(3))
}

/// Checks the columns of a transform's matrix, and its translation.
///
/// # Errors
/// If a number is not finite, or the matrix cannot be inverted, which rays require.
pub(super) fn check_transform(columns: [DVec3; 3], translation: DVec3) -> Result<()> {
    let [x, y, z] = columns;
    let is_finite = columns.iter().chain([&translation]).all(|column| column.is_finite());
    ensure!(is_finite, "its transform is not finite: {x}, {y}, {z}, {translation}");
    // Lengths are divided out: products of small ones vanish even in 64 bits.
    let is_flat = columns.contains(&DVec3::ZERO)
        || x.normalize().dot(y.normalize().cross(z.normalize())) == 0.0;
    ensure!(!is_flat, "its transform has no inverse, it makes everything flat: {x}, {y}, {z}");
    Ok(())
}
