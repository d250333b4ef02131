//! The top level of a formation: an instance and a record for each piece.

use anyhow::Result;
use ash::vk::GeometryInstanceFlagsKHR as Flags;
use common::gpu::{AccelerationStructure, Buffer, Gpu};
use common::scene::{Scene, SceneOnGpu, input_usage};
use glam::{DMat3, Mat3};

use crate::formation::{Formation, Piece};
use crate::instances;

common::shader_struct! {
    /// Data of one piece, found by its custom index.
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
        let tlas = instances::top_level(gpu, meshes, scene, pieces, white)?;
        let records: Vec<_> = pieces.iter().map(record).collect();
        let records = Buffer::with_data(gpu, "piece records", &records, input_usage())?;
        Ok(Self { tlas, records, flags: white })
    }
}

/// The inverse in f64, once per piece, and not in f32, once per ray or by the device.
fn record(piece: &Piece) -> PieceRecord {
    let columns = piece.linear.to_cols_array().map(f64::from);
    PieceRecord {
        inverse: DMat3::from_cols_array(&columns).inverse().as_mat3(),
        mesh: piece.mesh as u32,
        material: piece.material as u32,
        tone: piece.tone,
    }
}
