//! The legs of pieces, as played by 14.

use std::sync::LazyLock;

use super::{corpus, nothing, ours};
use crate::format::{Format, Function};
use crate::grammar::Grammar;

#[allow(missing_docs)]
#[path = "../../../samples/14_animation/legs.rs"]
mod file;
#[allow(missing_docs)]
#[path = "../../../samples/14_animation/leg.rs"]
mod leg;
#[allow(missing_docs)]
#[path = "../../../samples/14_animation/motion.rs"]
mod motion;

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/legs.txt")));

/// The text of a file of legs.
pub const FORMAT: Format = Format {
    name: "legs",
    file: "g.legs",
    most: 1 << 15,
    make: |random| GRAMMAR.text(random, 2000).into_bytes(),
    grammar: Some(|| &GRAMMAR),
    seeds: || [vec![ours("samples/assets/games/opera.legs")], corpus("legs")].concat(),
    seal: None,
};

/// The reader of the format.
pub const FUNCTION: Function = Function {
    beside: nothing,
    read: |path| {
        let motion = file::open(path)?;
        assert!((1..=36_000).contains(&motion.last) && (1..=256).contains(&motion.pieces.len()));
        let mut became = false;
        for frame in [0, 1, motion.last / 2, motion.last] {
            for (placed, piece) in motion.at(frame).zip(&motion.pieces) {
                assert!(placed.kind < motion::KINDS.len() && placed.side < motion::SIDES.len());
                assert!(
                    placed.at.translation.abs().max_element() <= 200.0,
                    "{frame}: {:?}",
                    placed.at
                );
                became |= placed.kind != piece.kind;
            }
        }
        let moves = motion.pieces.iter().any(|piece| !piece.legs.is_empty());
        Ok(format!("moves {moves} became {became}"))
    },
    memory: 16 << 20,
};
