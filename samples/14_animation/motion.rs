//! The place of every piece at a frame: a function of the frame's number alone.

use glam::{Affine3A, Mat3A, Vec3A};

use super::leg::{Motion, UNDER_WAY};

/// Names of the sides, and of the kinds of pieces.
pub const SIDES: [&str; 2] = ["white", "black"];
pub const KINDS: [&str; 6] = ["pawn", "rook", "knight", "bishop", "queen", "king"];

/// A piece at a frame: its kind, for a pawn may have become a queen, and its place.
pub struct Placed {
    pub side: usize,
    pub kind: usize,
    pub at: Affine3A,
}

impl Motion {
    /// Every piece at a frame, in their order.
    pub fn at(&self, frame: u32) -> impl Iterator<Item = Placed> {
        self.pieces.iter().map(move |piece| {
            let begun = piece.legs.partition_point(|leg| leg.begin <= frame);
            let (done, last) = (&piece.legs[..begun.saturating_sub(1)], piece.legs[..begun].last());
            let place = last.map_or(piece.home, |leg| leg.at(frame.into()));
            let arrived = last.filter(|leg| frame >= leg.begin + UNDER_WAY);
            // A pawn is another piece from the frame on in which it arrives.
            let became = done.iter().chain(arrived).filter_map(|leg| leg.becomes).next_back();
            let (side, kind) = (piece.side, became.unwrap_or(piece.kind));
            // Pieces are modelled facing +x. They look at the other side, and a little past it.
            let yaw: f32 = [140.0, -40.0][side];
            let matrix3 = Mat3A::from_rotation_y(yaw.to_radians());
            Placed { side, kind, at: Affine3A { matrix3, translation: Vec3A::from(place) } }
        })
    }
}
