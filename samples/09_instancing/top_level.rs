//! The top level of a formation: an instance and a record for each piece.

use anyhow::Result;
use ash::vk;
use ash::vk::GeometryInstanceFlagsKHR as Flags;
use common::gpu::{AccelerationStructure, Buffer, Gpu, order};
use common::scene::{Scene, SceneOnGpu, build_top, input_usage, transform};
use glam::{DMat3, Mat3};

use crate::formation::{BLACK, BOARD, Formation, Piece, WHITE};

/// Which bits a ray asks for: it sees an instance if they share one.
pub const SEEN: [(&str, u8); 4] = [
    ("everything", 0xff),
    ("all but white", BOARD | BLACK),
    ("all but black", BOARD | WHITE),
    ("the board", BOARD),
];

const NO_FLAGS: Flags = Flags::empty();
/// What an instance may say of its triangles.
pub const FLAGS: [(&str, Flags); 4] = [
    ("none", NO_FLAGS),
    ("facing cull disable", Flags::TRIANGLE_FACING_CULL_DISABLE),
    ("flip facing", Flags::TRIANGLE_FLIP_FACING),
    ("force no-opaque", Flags::FORCE_NO_OPAQUE),
];

common::shader_struct! {
    /// What a piece has of its own, at its custom index.
    pub struct PieceRecord {
        inverse: Mat3,
        mesh: u32,
        material: u32,
        tone: f32,
    }
}

/// Every piece as an instance of the top level.
pub struct TopLevel {
    pub tlas: AccelerationStructure,
    /// A [`PieceRecord`] each, by custom index.
    pub records: Buffer,
    /// The flags of the white pieces.
    pub flags: Flags,
}

impl TopLevel {
    pub fn new(
        gpu: &Gpu,
        meshes: &Scene,
        scene: &SceneOnGpu,
        formation: &Formation,
        white: Flags,
    ) -> Result<Self> {
        let pieces = &formation.pieces;
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
        let tlas = build_top(gpu, &instances.collect::<Vec<_>>())?;
        // ANCHOR_END: instances
        let records: Vec<_> = pieces.iter().map(record).collect();
        let records = Buffer::with_data(gpu, "piece records", &records, input_usage())?;
        Ok(Self { tlas, records, flags: white })
    }
}

/// The inverse in f64, once a piece, and not in f32, once a ray or by the device.
fn record(piece: &Piece) -> PieceRecord {
    let columns = piece.linear.to_cols_array().map(f64::from);
    PieceRecord {
        inverse: DMat3::from_cols_array(&columns).inverse().as_mat3(),
        mesh: piece.mesh as u32,
        material: piece.material as u32,
        tone: piece.tone,
    }
}
