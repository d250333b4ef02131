//! The place of every piece at a time, in frames: a function of that time alone.

use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};

use super::leg::{Leg, Motion, UNDER_WAY, smooth};
use super::shutter::Pose;

/// Names of the sides, and of the kinds of pieces.
pub const SIDES: [&str; 2] = ["white", "black"];
pub const KINDS: [&str; 7] = ["pawn", "rook", "knight", "bishop", "queen", "king", "ball"];

/// A piece at a time: its kind, for a pawn may have become a queen, and its place.
pub struct Placed {
    pub side: usize,
    pub kind: usize,
    /// Degrees about the vertical.
    pub yaw: f32,
    pub place: Vec3,
}

impl Placed {
    pub fn pose(&self) -> Pose {
        Pose { place: self.place, rotation: Quat::from_rotation_y(self.yaw.to_radians()) }
    }

    pub fn at(&self) -> Affine3A {
        let matrix3 = Mat3A::from_rotation_y(self.yaw.to_radians());
        Affine3A { matrix3, translation: Vec3A::from(self.place) }
    }
}

impl Leg {
    /// The angle by which a lifted piece has turned, in degrees; it arrives as it set out.
    fn turned(&self, time: f64, turns: u32) -> f32 {
        let across = smooth((self.part(time) - 0.2) / 0.6);
        if self.lift > 0.0 && across < 1.0 { 360.0 * turns as f32 * across } else { 0.0 }
    }
}

impl Motion {
    /// Every piece at a time, in their order; those that are lifted turn so many times on their way.
    pub fn at(&self, time: f64, turns: u32) -> impl Iterator<Item = Placed> {
        self.pieces.iter().map(move |piece| {
            let begun = piece.legs.partition_point(|leg| f64::from(leg.begin) <= time);
            let (done, last) = (&piece.legs[..begun.saturating_sub(1)], piece.legs[..begun].last());
            let place = last.map_or(piece.home, |leg| leg.at(time));
            let arrived = last.filter(|leg| time >= f64::from(leg.begin + UNDER_WAY));
            // A pawn is another piece from the frame on in which it arrives.
            let became = done.iter().chain(arrived).filter_map(|leg| leg.becomes).next_back();
            let (side, kind) = (piece.side, became.unwrap_or(piece.kind));
            // Pieces are modelled facing +x. They look at the other side, and a little past it.
            let yaw = [140.0, -40.0][side] + last.map_or(0.0, |leg| leg.turned(time, turns));
            Placed { side, kind, yaw, place }
        })
    }

    /// The most pieces that are under way at any time, seen through a shutter that is open for so many frames.
    pub fn most_under_way(&self, shutter: f32) -> usize {
        let legs = || self.pieces.iter().flat_map(|piece| &piece.legs);
        let begins = legs().map(|leg| leg.begin);
        // The most are under way when one has just set out.
        let open = begins.map(|begin| {
            let within = |leg: &&Leg| {
                let ended = f64::from(leg.begin + UNDER_WAY) + f64::from(shutter);
                leg.begin <= begin && f64::from(begin) <= ended
            };
            legs().filter(within).count()
        });
        open.max().unwrap_or(0)
    }
}
