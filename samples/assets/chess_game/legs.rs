//! Moves of the pieces in a game, in time and space: text that 14 reads.

use std::fmt::Write;

use glam::Vec3;

use super::position::{Kind, Man, Played, Position, Side, Square, squares};

/// Frames before the first move, and of every half-move.
const LEAD: usize = 48;
const HALF_MOVE: usize = 48;
/// A piece that takes waits a moment until its square is free.
const WAIT: usize = 10;
/// Frames after the last move.
const END: usize = 192;
/// The height of a piece lifted over others, and the height of the table, where captured pieces are.
const LIFT: f32 = 2.3;
const TABLE: f32 = -0.34;

/// The legs of a game whose moves are in the file `name`.
pub fn write(game: &[Played], name: &str) -> String {
    let start = Position::start();
    let mut men: Vec<_> =
        squares().filter_map(|square| Some((start.at(square)?, square))).collect();
    men.sort_by_key(|(man, _)| man.number);
    let mut text = format!(
        "# Who stands where, and who goes where in which frames. Made of {name} by `cargo run --bin chess_game`.\n\
         last {}\n\n# side, kind, place\n",
        LEAD + HALF_MOVE * game.len() + END
    );
    for (Man { side, kind, .. }, square) in men {
        let side = side.to_string().to_lowercase();
        let _ = writeln!(text, "piece {side} {kind} {}", words(place(square)));
    }
    text += "\n# first frame, which of the pieces above, counted from 0, place, lift, what it becomes\n";
    let mut taken = [0, 0];
    for (number, &Played { man, by, taken: victim, rook }) in game.iter().enumerate() {
        let begin = LEAD + HALF_MOVE * number;
        let mut go = |man: Man, begin, to, lift, becomes: Option<Kind>| {
            let becomes = becomes.map(|kind| format!(" {kind}")).unwrap_or_default();
            let _ = writeln!(text, "leg {begin} {} {} {lift}{becomes}", man.number, words(to));
        };
        if let Some(victim) = victim {
            let count = &mut taken[victim.side as usize];
            go(victim, begin, aside(victim.side, *count), LIFT, None);
            *count += 1;
        }
        let lift = if man.kind == Kind::Knight { LIFT } else { 0.0 };
        go(man, begin + WAIT, place(by.to), lift, by.becomes);
        if let Some((rook, _, to)) = rook {
            go(rook, begin + WAIT, place(to), LIFT, None);
        }
    }
    text
}

fn words(at: Vec3) -> String {
    format!("{} {} {}", at.x, at.y, at.z)
}

/// The middle of a square: White is at +z.
fn place(square: Square) -> Vec3 {
    Vec3::new(f32::from(square.file) - 3.5, 0.0, 3.5 - f32::from(square.rank))
}

/// The place next to the board for a side's captured pieces.
fn aside(side: Side, count: u8) -> Vec3 {
    let (row, rank) = (f32::from(count % 2), f32::from(count / 2));
    let (way, from) = if side == Side::White { (-1.0, -3.5) } else { (1.0, 3.5) };
    Vec3::new(way * (5.4 + 0.95 * row), TABLE, from - way * rank)
}
