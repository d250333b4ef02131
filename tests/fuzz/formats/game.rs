//! The moves of a game, which `chess_game` turns into legs.

use std::sync::LazyLock;

use reference::random::Random;

use super::{corpus, nothing, ours};
use crate::format::{Format, Function};
use crate::grammar::Grammar;

#[allow(dead_code, missing_docs)]
#[path = "../../../samples/assets/chess_game/game.rs"]
mod moves;
#[allow(dead_code, missing_docs)]
#[path = "../../../samples/assets/chess_game/position.rs"]
mod position;

use position::{Kind, Move, Position, squares};

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/game.txt")));

/// The text of a game.
pub const FORMAT: Format = Format {
    name: "game",
    file: "g.txt",
    most: 1 << 15,
    make,
    grammar: Some(|| &GRAMMAR),
    seeds: || [vec![ours("samples/assets/games/opera.txt")], corpus("game")].concat(),
    seal: None,
};

/// The reader of the format.
pub const FUNCTION: Function = Function {
    beside: nothing,
    read: |path| {
        let game = moves::open(path)?;
        let became = game.iter().filter(|played| played.by.becomes.is_some()).count();
        let taken = game.iter().filter(|played| played.taken.is_some()).count();
        assert!(game.len() <= moves::MOST && taken <= 30 && became <= 16);
        let castled = game.iter().any(|played| played.rook.is_some());
        Ok(format!("became {} castled {castled}", became > 0))
    },
    memory: 16 << 20,
};

/// Generates a text by the grammar, or random moves by the rules for as long as possible.
fn make(random: &mut Random) -> Vec<u8> {
    if random.below(4) > 0 {
        return GRAMMAR.text(random, 2000).into_bytes();
    }
    let mut position = Position::start();
    let mut text = String::new();
    for _ in 0..random.below(120) {
        let squares: Vec<_> = squares().collect();
        let mut tries = (0..2000).map(|_| {
            let [from, to] = [(); 2].map(|()| squares[random.below(64)]);
            let becomes = [None, None, Some(Kind::Queen), Some(Kind::Knight)][random.below(4)];
            Move { from, to, becomes }
        });
        let Some(by) = tries.find(|&by| position.play(by).is_ok()) else { break };
        let becomes = match by.becomes {
            Some(Kind::Queen) => "=Q",
            Some(_) => "=N",
            None => "",
        };
        text += &format!("{}-{}{becomes}\n", by.from, by.to);
    }
    text.into_bytes()
}
