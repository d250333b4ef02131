//! The extent of a scene: rays must be able to hit it.

use anyhow::{Result, ensure};
use glam::{DAffine3, DMat3, DMat4, DVec3, Vec3};

use crate::scene::mesh::{LEAST, Mesh, REACH};

/// The box around everything, in 64 bits.
pub(super) fn bounds(meshes: &[Mesh], instances: &[(usize, DAffine3)]) -> (DVec3, DVec3) {
    let boxes: Vec<_> = meshes.iter().map(Mesh::bounds).collect();
    let moved = |&(mesh, transform): &(usize, DAffine3)| {
        let (low, high): (Vec3, Vec3) = boxes[mesh];
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let half = (high - low) * 0.5;
        let middle = transform.transform_point3((low + high) * 0.5);
        let DMat3 { x_axis, y_axis, z_axis } = transform.matrix3;
        let reach = x_axis.abs() * half.x + y_axis.abs() * half.y + z_axis.abs() * half.z;
        (middle - reach, middle + reach)
    };
    instances
        .iter()
        .map(moved)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (l, h)| {
            (low.min(l), high.max(h))
        })
}

/// Checks that rays can hit the model.
///
/// # Errors
/// States its reach or its size, and the bound.
pub(super) fn check_size(low: DVec3, high: DVec3) -> Result<()> {
    let reach = low.abs().max(high.abs()).max_element();
    ensure!(
        reach <= REACH.into(),
        "reaches {reach:e} from the origin; beyond {REACH:e}, products of four coordinates overflow in 32 bits"
    );
    let size = (high - low).max_element();
    ensure!(
        size == 0.0 || size >= LEAST.into(),
        "is {size:e} from end to end; below {LEAST:e}, products of two lengths vanish in 32 bits"
    );
    Ok(())
}

/// True if a transform is finite and does not make everything flat.
pub(super) fn is_solid(transform: &DMat4) -> bool {
    let small = DAffine3::from_mat4(*transform);
    let columns = [small.matrix3.x_axis, small.matrix3.y_axis, small.matrix3.z_axis];
    let columns = columns.map(|column| column.as_vec3().as_dvec3());
    let is_finite =
        columns.iter().all(|column| column.is_finite()) && small.translation.as_vec3().is_finite();
    let [x, y, z] = columns.map(DVec3::normalize_or_zero);
    is_finite && x.dot(y.cross(z)) != 0.0
}
