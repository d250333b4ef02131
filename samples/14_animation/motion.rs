//! Where every piece is at a frame: a function of the frame's number, and of nothing else.

use glam::{Affine3A, Mat3A, Vec3, Vec3A};

/// Whose a piece is, and what it is.
pub const SIDES: [&str; 2] = ["white", "black"];
pub const KINDS: [&str; 6] = ["pawn", "rook", "knight", "bishop", "queen", "king"];

/// Frames that a piece is under way.
pub const UNDER_WAY: u32 = 34;

// ANCHOR: leg
/// A piece on its way: from here to there, in these frames.
pub struct Leg {
    pub begin: u32,
    pub from: Vec3,
    pub to: Vec3,
    pub lift: f32,
    pub becomes: Option<usize>,
}

impl Leg {
    /// The place at a frame that is not before the first.
    fn at(&self, frame: u32) -> Vec3 {
        let part = (frame - self.begin) as f32 / UNDER_WAY as f32;
        let (across, up) = match self.lift > 0.0 {
            true => (smooth((part - 0.2) / 0.6), smooth(part / 0.35) * smooth((1.0 - part) / 0.35)),
            false => (smooth(part), 0.0),
        };
        self.from.lerp(self.to, across) + up * self.lift * Vec3::Y
    }
}

/// From 0 to 1 without a jerk at either end.
fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
// ANCHOR_END: leg

/// A piece through a whole game: its side and kind by number, where it stands at first, and its legs in order.
pub struct Piece {
    pub side: usize,
    pub kind: usize,
    pub home: Vec3,
    pub legs: Vec<Leg>,
}

/// All pieces, and the last frame.
pub struct Motion {
    pub pieces: Vec<Piece>,
    pub last: u32,
}

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
            let place = last.map_or(piece.home, |leg| leg.at(frame));
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
