//! Where every piece is at a frame: a function of the game and of the frame's number, and of nothing else.

use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use super::position::{Kind, Man, Played, Position, Side, Square, squares};

/// Frames before the first move, and of every half-move.
const LEAD: u32 = 48;
const HALF_MOVE: u32 = 48;
/// Frames that a piece is under way; one that takes waits a moment until its square is free.
const UNDER_WAY: u32 = 34;
const WAIT: u32 = 10;
/// Frames after the last move.
const END: u32 = 192;
/// How high a piece is lifted over others, and where the taken ones stand: the table's height.
const LIFT: f32 = 2.3;
pub const TABLE: f32 = -0.34;

// ANCHOR: leg
/// A piece on its way: from here to there, in these frames.
struct Leg {
    begin: u32,
    from: Vec3,
    to: Vec3,
    lift: f32,
    becomes: Option<Kind>,
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

struct Piece {
    man: Man,
    home: Vec3,
    legs: Vec<Leg>,
}

/// All pieces through a whole game.
pub struct Motion {
    pieces: Vec<Piece>,
    /// The last frame.
    pub last: u32,
}

/// A piece at a frame: its kind, for a pawn may have become a queen, and its place.
pub struct Placed {
    pub man: Man,
    pub at: Affine3A,
}

impl Motion {
    pub fn new(game: &[Played]) -> Self {
        let start = Position::start();
        let men = squares().filter_map(|square| Some((start.at(square)?, square)));
        let piece = |(man, square)| Piece { man, home: place(square), legs: Vec::new() };
        let mut pieces: Vec<_> = men.map(piece).collect();
        pieces.sort_by_key(|piece| piece.man.number);
        let mut motion = Self { pieces, last: LEAD + HALF_MOVE * game.len() as u32 + END };
        let mut taken = [0, 0];
        for (number, played) in game.iter().enumerate() {
            let begin = LEAD + HALF_MOVE * number as u32;
            let Played { man, by, rook, .. } = *played;
            let lift = if man.kind == Kind::Knight { LIFT } else { 0.0 };
            if let Some(victim) = played.taken {
                let count = &mut taken[victim.side as usize];
                motion.go(victim, begin, aside(victim.side, *count), LIFT, None);
                *count += 1;
            }
            motion.go(man, begin + WAIT, place(by.to), lift, by.becomes);
            if let Some((rook, _, to)) = rook {
                motion.go(rook, begin + WAIT, place(to), LIFT, None);
            }
        }
        motion
    }

    fn go(&mut self, man: Man, begin: u32, to: Vec3, lift: f32, becomes: Option<Kind>) {
        let piece = &mut self.pieces[man.number];
        let from = piece.legs.last().map_or(piece.home, |leg| leg.to);
        piece.legs.push(Leg { begin, from, to, lift, becomes });
    }

    // ANCHOR: frame
    /// Every piece at a frame, in the order of their numbers.
    pub fn at(&self, frame: u32) -> impl Iterator<Item = Placed> {
        self.pieces.iter().map(move |piece| {
            let begun = piece.legs.partition_point(|leg| leg.begin <= frame);
            let (done, last) = (&piece.legs[..begun.saturating_sub(1)], piece.legs[..begun].last());
            let place = last.map_or(piece.home, |leg| leg.at(frame));
            let arrived = last.filter(|leg| frame >= leg.begin + UNDER_WAY);
            // A pawn is another piece from the frame on in which it arrives.
            let kind = done.iter().chain(arrived).filter_map(|leg| leg.becomes).next();
            let man = Man { kind: kind.unwrap_or(piece.man.kind), ..piece.man };
            // Pieces are modelled facing +x. They look at the other side, and a little past it.
            let yaw: f32 = if man.side == Side::White { 140.0 } else { -40.0 };
            let matrix3 = Mat3A::from_rotation_y(yaw.to_radians());
            Placed { man, at: Affine3A { matrix3, translation: Vec3A::from(place) } }
        })
    }
    // ANCHOR_END: frame
}

/// The middle of a square: White is at +z.
fn place(square: Square) -> Vec3 {
    Vec3::new(f32::from(square.file) - 3.5, 0.0, 3.5 - f32::from(square.rank))
}

/// Beside the board, where the pieces of a side stand that were taken.
fn aside(side: Side, count: u8) -> Vec3 {
    let (row, rank) = (f32::from(count % 2), f32::from(count / 2));
    let (way, from) = if side == Side::White { (-1.0, -3.5) } else { (1.0, 3.5) };
    Vec3::new(way * (5.4 + 0.95 * row), TABLE, from - way * rank)
}
