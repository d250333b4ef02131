//! The way of a piece: legs, each from here to there in so many frames.

use glam::Vec3;

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
    /// The place at a time, in frames, that is not before the first.
    pub fn at(&self, time: f64) -> Vec3 {
        let part = self.part(time);
        let (across, up) = if self.lift > 0.0 {
            (smooth((part - 0.2) / 0.6), smooth(part / 0.35) * smooth((1.0 - part) / 0.35))
        } else {
            (smooth(part), 0.0)
        };
        self.from.lerp(self.to, across) + up * self.lift * Vec3::Y
    }

    /// The part of the leg that is over.
    pub fn part(&self, time: f64) -> f32 {
        (time - f64::from(self.begin)) as f32 / UNDER_WAY as f32
    }
}
// ANCHOR_END: leg

/// From 0 to 1 without a jerk at either end.
pub fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// A piece through a whole game: its side and kind by number, its first place, and its legs in order.
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
