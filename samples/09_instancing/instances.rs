//! The pieces as instances, with the masks and flags that decide what a ray sees of them.

use anyhow::Result;
use ash::vk;
use ash::vk::GeometryInstanceFlagsKHR as Flags;
use common::gpu::{AccelerationStructure, Gpu, order};
use common::scene::{Scene, SceneOnGpu, build_top, transform};

use crate::formation::{BLACK, BOARD, Piece, WHITE};

/// Cull masks of a ray: it sees an instance if they share a bit.
pub const SEEN: [(&str, u8); 4] = [
    ("everything", 0xff),
    ("all but white", BOARD | BLACK),
    ("all but black", BOARD | WHITE),
    ("the board", BOARD),
];

const NO_FLAGS: Flags = Flags::empty();
/// Flags of an instance, which apply to its triangles.
pub const FLAGS: [(&str, Flags); 4] = [
    ("none", NO_FLAGS),
    ("facing cull disable", Flags::TRIANGLE_FACING_CULL_DISABLE),
    ("flip facing", Flags::TRIANGLE_FLIP_FACING),
    ("force no-opaque", Flags::FORCE_NO_OPAQUE),
];

/// The top level of all pieces; `white` are the flags of the white ones.
pub fn top_level(
    gpu: &Gpu,
    meshes: &Scene,
    scene: &SceneOnGpu,
    pieces: &[Piece],
    white: Flags,
) -> Result<AccelerationStructure> {
    let bounds = pieces.iter().map(|piece| meshes.instance_bounds(&piece.instance()));
    let bounds: Vec<_> = bounds.collect();
    let order = order::for_build(gpu, &bounds, scene.options.ordering);
    // ANCHOR: instances
    let instances = order.iter().map(|&index| {
        let piece = &pieces[index as usize];
        let flags = if piece.mask == WHITE { white } else { NO_FLAGS };
        vk::AccelerationStructureInstanceKHR {
            transform: transform(&piece.instance().transform),
            // Eight bits of mask; the index has 24, so 16,777,216 pieces at most.
            instance_custom_index_and_mask: vk::Packed24_8::new(index, piece.mask),
            instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(
                0,
                flags.as_raw() as u8,
            ),
            acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
                device_handle: scene.blas[piece.mesh].address,
            },
        }
    });
    build_top(gpu, &instances.collect::<Vec<_>>())
    // ANCHOR_END: instances
}
