//! The legs of all pieces, from a text file: their first places, and their moves in ranges of frames.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;
use std::str::FromStr;

use anyhow::{Context, Result, bail, ensure};
use common::model::text::{Text, quoted, shown, uncommented};
use glam::Vec3;

use super::leg::{Leg, Motion, Piece, UNDER_WAY};
use super::motion::{KINDS, SIDES};

/// The most bytes, pieces and frames of a file.
const BYTES: u64 = 64 << 10;
const PIECES: usize = 256;
const FRAMES: u32 = 36_000;
/// Maximum distance of a piece from the middle of the board.
const FAR: f32 = 100.0;

const LINES: &str = "a line is 'last FRAME', 'piece SIDE KIND X Y Z', or 'leg FRAME PIECE X Y Z LIFT' and a KIND \
                     if the piece becomes another";

/// Reads a file of legs. What follows a `#` is a comment.
///
/// # Errors
/// If the file cannot be read, or at the first line that is wrong, with the line and what would be right.
pub fn open(path: &Path) -> Result<Motion> {
    let text = Text::read(path, shown(path), BYTES)?;
    let mut motion = Motion { pieces: Vec::new(), last: 0 };
    for statement in text.statements() {
        let read = statement.split().and_then(|(word, rest)| line(&mut motion, word, rest));
        read.map_err(|error| statement.at(error))?;
    }
    ensure!(
        motion.last > 0 && !motion.pieces.is_empty(),
        "{}: there is no last frame in it, or no piece, such as 'last 240' and 'piece white king 0.5 0 3.5'",
        shown(path)
    );
    Ok(motion)
}

fn line(Motion { pieces, last }: &mut Motion, word: &str, rest: &str) -> Result<()> {
    let words: Vec<_> = uncommented(rest).split_whitespace().collect();
    match (word, &words[..]) {
        ("last", [frame]) => *last = number(frame, 1..=FRAMES)?,
        ("piece", [side, kind, home @ ..]) if home.len() == 3 => {
            ensure!(pieces.len() < PIECES, "more than {PIECES} pieces");
            let (side, kind) = (one_of(&SIDES, side)?, one_of(&KINDS, kind)?);
            pieces.push(Piece { side, kind, home: place(home)?, legs: Vec::new() });
        }
        ("leg", [begin, piece, rest @ ..]) if matches!(rest.len(), 4 | 5) => {
            let begin = number(begin, 0..=*last)?;
            let count = pieces.len();
            let index: usize = number(piece, 0..=PIECES - 1)?;
            let piece = pieces.get_mut(index);
            let piece =
                piece.with_context(|| format!("there is no piece {index}: {count} stand above"))?;
            let before = piece.legs.last();
            let (free, from) =
                before.map_or((0, piece.home), |leg| (leg.begin + UNDER_WAY, leg.to));
            ensure!(begin >= free, "piece {index} is under way until frame {free}");
            let becomes = rest.get(4).map(|kind| one_of(&KINDS, kind)).transpose()?;
            let (to, lift) = (place(&rest[..3])?, number(rest[3], 0.0..=FAR)?);
            piece.legs.push(Leg { begin, from, to, lift, becomes });
        }
        _ => bail!("{LINES}"),
    }
    Ok(())
}

fn place(words: &[&str]) -> Result<Vec3> {
    let mut at = Vec3::ZERO;
    for (axis, word) in words.iter().enumerate() {
        at[axis] = number(word, -FAR..=FAR)?;
    }
    Ok(at)
}

fn number<T: FromStr + PartialOrd + Display>(word: &str, range: RangeInclusive<T>) -> Result<T> {
    let value = word.parse::<T>().ok().filter(|value| range.contains(value));
    value.with_context(|| {
        format!("{} is no number from {} to {}", quoted(word), range.start(), range.end())
    })
}

fn one_of(names: &[&str], word: &str) -> Result<usize> {
    let found = names.iter().position(|name| *name == word);
    found.with_context(|| format!("{} is none of {}", quoted(word), names.join(", ")))
}
