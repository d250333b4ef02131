//! A game: the moves of a text file, each checked by the rules of chess.

use std::path::Path;

use anyhow::{Result, ensure};
use common::model::text::{Text, quoted, shown, uncommented};

use super::position::{Kind, Move, Played, Position, Square};

/// The most half-moves of a game. The longest that masters have played had 538.
pub const MOST: usize = 600;
/// The most bytes of a file.
const FILE_BYTES: u64 = 64 << 10;

/// Reads a file of moves: one a line, such as `e2-e4` or `e7-e8=Q`; castling is the king's move. What follows a
/// `#` is a comment.
///
/// # Errors
/// If the file cannot be read, or at the first line that holds no move or one that the rules forbid, with the line
/// and what would be right.
pub fn open(path: &Path) -> Result<Vec<Played>> {
    let text = Text::read(path, shown(path), FILE_BYTES)?;
    let (mut position, mut game) = (Position::start(), Vec::new());
    for statement in text.statements() {
        let played = statement.split().and_then(|(word, rest)| {
            ensure!(game.len() < MOST, "more than {MOST} moves");
            let rest = if word.contains('#') { "" } else { uncommented(rest) };
            ensure!(rest.is_empty(), "{} after a move; a line has one", quoted(rest.trim()));
            let by = parse(uncommented(word))?;
            position.play(by).map_err(anyhow::Error::msg)
        });
        game.push(played.map_err(|error| statement.at(error))?);
    }
    ensure!(!game.is_empty(), "{}: there is no move in it, such as e2-e4", shown(path));
    Ok(game)
}

fn parse(word: &str) -> Result<Move> {
    let read = || {
        let (squares, becomes) = match word.split_once('=') {
            Some((squares, letter)) => (squares, Some(piece(letter)?)),
            None => (word, None),
        };
        let (from, to) = squares.split_once('-')?;
        Some(Move { from: square(from)?, to: square(to)?, becomes })
    };
    let example = "a move is from where to where, as e2-e4, or e7-e8=Q";
    read().ok_or_else(|| anyhow::anyhow!("{} is no move: {example}", quoted(word)))
}

fn square(text: &str) -> Option<Square> {
    let &[file @ b'a'..=b'h', rank @ b'1'..=b'8'] = text.as_bytes() else { return None };
    Some(Square { file: (file - b'a') as i8, rank: (rank - b'1') as i8 })
}

fn piece(letter: &str) -> Option<Kind> {
    Some(match letter {
        "Q" => Kind::Queen,
        "R" => Kind::Rook,
        "B" => Kind::Bishop,
        "N" => Kind::Knight,
        "K" => Kind::King,
        "P" => Kind::Pawn,
        _ => return None,
    })
}
