//! Makes what 14 plays of a game's moves: `opera.legs` of `opera.txt`, or the legs of a game of yours. The rules of
//! chess are known here and nowhere else.
//!
//! `chess_game --check` writes nothing and fails if the file differs from what it would write.

mod game;
mod legs;
mod position;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use common::UsageError;
use common::exit::finish;
use common::files::write_whole;
use common::model::text::shown;
use common::output;

/// The game of the book: Morphy's at the opera.
const MOVES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/assets/games/opera.txt");

const USAGE: &str = "usage: chess_game            write opera.legs, which 14 plays\n       \
                     chess_game --check    only say whether it is as it would be written\n       \
                     chess_game GAME.txt   write GAME.legs of the moves of a game, a half-move a line: e2-e4\n";

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    finish(|| match &arguments[..] {
        [] => make(Path::new(MOVES), false),
        [one] if one == "--check" => make(Path::new(MOVES), true),
        [one] if one == "--help" || one == "-h" => output::print(USAGE),
        [one] if Path::new(one).extension().is_some_and(|end| end.eq_ignore_ascii_case("txt")) => {
            make(Path::new(one), false)
        }
        _ => {
            let all: Vec<_> = arguments.iter().map(|one| shown(Path::new(one))).collect();
            let all = all.join(" ");
            Err(UsageError(format!(
                "chess_game takes moves (.txt), --check, or nothing, and not '{all}'"
            ))
            .into())
        }
    })
}

/// Writes the legs of a game, or only compares them.
fn make(moves: &Path, check: bool) -> Result<()> {
    let game = game::open(moves)?;
    let name = moves.file_name().unwrap_or_default();
    let text = legs::write(&game, &shown(Path::new(name)));
    let path = moves.with_extension("legs");
    if !check {
        write_whole(&path, text.as_bytes())?;
        return output::print(&format!("{}: {} half-moves\n", shown(&path), game.len()));
    }
    let found = std::fs::read(&path).with_context(|| format!("reading {}", shown(&path)))?;
    ensure!(found == text.as_bytes(), "{} is out of date: run chess_game", shown(&path));
    Ok(())
}
