//! The game played by 14 obeys the rules of chess: `chess_game` knows them, and refuses illegal moves with
//! one line.

use std::fmt::Write;

use super::motion::{KINDS, SIDES};
use super::position::{Kind, Move, Position, Square, squares};
use super::turned::TABLE;
use super::{game, opera};

use common::scene::assets;
use run::refused;

/// Reads such a file: the number of moves, or the message.
fn read(text: &[u8]) -> Result<usize, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("game.txt");
    std::fs::write(&path, text).unwrap();
    let read = game::open(&path).map(|game| game.len()).map_err(|error| format!("{error:#}"));
    read.map_err(|line| line.replace(&path.display().to_string(), "game.txt"))
}

#[test]
fn legal_games_are_read_with_all_special_moves() {
    assert_eq!(read(b"e2-e4\r\n\r\n# a comment\r\ne7-e5 # so\r\ng1-f3#too"), Ok(3));
    assert_eq!(read(b"\xef\xbb\xbfe2-e4\n"), Ok(1));
    let en_passant = "e2-e4\na7-a6\ne4-e5\nd7-d5\ne5-d6\n";
    assert_eq!(read(en_passant.as_bytes()), Ok(5));
    let castling = "g1-f3\ng8-f6\ng2-g3\ng7-g6\nf1-g2\nf8-g7\ne1-g1\ne8-g8\n";
    assert_eq!(read(castling.as_bytes()), Ok(8));
    let promotion = "a2-a4\nb7-b5\na4-b5\na7-a6\nb5-a6\nc8-b7\na6-b7\nb8-c6\nb7-a8=N\nd8-a8\n";
    assert_eq!(read(promotion.as_bytes()), Ok(10));
}

#[test]
fn what_the_rules_forbid_is_refused_with_its_line_and_what_they_allow() {
    for (text, line) in [
        ("e2-e5", "game.txt:1: the pawn on e2 cannot go to e5: it may go to e3, e4"),
        ("# so\ne4-e5", "game.txt:2: nothing stands on e4; White is to move"),
        ("e7-e5", "game.txt:1: the pawn on e7 is Black's, and White is to move"),
        ("a1-a3", "game.txt:1: the rook on a1 cannot go to a3: it has no move here"),
        ("g1-f3\ng8-f6\ne1-g1", "cannot go to g1: it has no move here"),
        // A pinned piece, and a king in check from a queen.
        (
            "e2-e4\ne7-e5\nb1-c3\nf8-b4\nd2-d3\na7-a6\nc3-d5",
            "game.txt:7: c3-d5 would leave White's king attacked: it has no move here",
        ),
        (
            "f2-f3\ne7-e5\ng2-g4\nd8-h4\ne1-f2",
            "game.txt:5: e1-f2 would leave White's king attacked",
        ),
        // A pawn may be captured en passant at once or never.
        ("e2-e4\na7-a6\ne4-e5\nd7-d5\nh2-h3\nh7-h6\ne5-d6", "cannot go to d6: it may go to e6"),
        // The king passes over f1, which is attacked by a bishop on a6.
        (
            "e2-e4\nb7-b6\ng1-f3\nc8-a6\nf1-a6\nb8-a6\ng2-g3\na6-b8\nd2-d3\nd8-c8\na2-a3\nc8-a6\nh2-h4\na6-d3\ne1-g1",
            "game.txt:15: the king on e1 cannot go to g1",
        ),
        (
            "a2-a4\nb7-b5\na4-b5\na7-a6\nb5-a6\nc8-b7\na6-b7\nb8-c6\nb7-a8",
            "becomes a piece: b7-a8=Q",
        ),
        ("e2-e4=Q", "game.txt:1: only a pawn at the last rank becomes something; write e2-e4"),
        (
            "a2-a4\nb7-b5\na4-b5\na7-a6\nb5-a6\nc8-b7\na6-b7\nb8-c6\nb7-a8=K",
            "becomes a queen, rook, bishop or knight",
        ),
    ] {
        let refused = read(format!("{text}\n").as_bytes()).unwrap_err();
        assert!(refused.contains(line), "{text:?}: {refused}");
    }
}

#[test]
fn a_file_that_is_no_game_is_refused_in_one_line() {
    let long = [&b"e2-e4\n"[..], &[b'x'; 10_000], b"\n"].concat();
    let mut many = String::new();
    for _ in 0..151 {
        many.push_str("g1-f3\ng8-f6\nf3-g1\nf6-g8\n");
    }
    for (text, words) in [
        (&b""[..], "game.txt: there is no move in it, such as e2-e4"),
        (b"# nothing\n", "there is no move in it"),
        (b"e2-e4\n\0\n", "game.txt:2: holds a zero byte"),
        (
            b"e2-e4\nNf6\n",
            "game.txt:2: \"Nf6\" is no move: a move is from where to where, as e2-e4",
        ),
        (b"e2-e9\n", "game.txt:1: \"e2-e9\" is no move"),
        (b"e2-e4=X\n", "\"e2-e4=X\" is no move"),
        (b"e2-e4 e7-e5\n", "game.txt:1: \"e7-e5\" after a move; a line has one"),
        (b"\xff\xfe\xff\n", "game.txt:1: this is UTF-16 text; save it as UTF-8"),
        (
            b"e2-e4\ne7-",
            "is no move: a move is from where to where, as e2-e4, or e7-e8=Q; the file ends in this line",
        ),
        (&long, "game.txt:2: \"xxxxxxxxxx"),
        (many.as_bytes(), "game.txt:601: more than 600 moves"),
        (&[b'#'; 70_000], "is too large: 70000 bytes, at most 65536 are read"),
    ] {
        let refused = read(text).unwrap_err();
        assert!(refused.contains(words) && refused.len() < 300, "{refused}");
        assert_eq!(refused.lines().count(), 1);
    }
}

/// The file of legs is generated and never edited by hand.
#[test]
fn the_legs_are_those_of_the_moves() {
    let output = run::command("chess_game").arg("--check").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// After each half-move, the frames show the same pieces on the same squares as the rules' board; all others
/// are on the table.
#[test]
fn after_every_move_each_piece_stands_where_the_rules_say() {
    let (mut position, motion) = (Position::start(), opera());
    let game = game::open(&assets().join("games/opera.txt")).unwrap();
    for (number, played) in game.iter().enumerate() {
        position.play(played.by).unwrap();
        let mut standing = 0;
        for piece in motion.at(48 * (number as u32 + 2) - 1) {
            let at = piece.at.translation;
            if at.y == TABLE {
                assert!(at.x.abs() > 5.0, "move {number}: {at}");
                continue;
            }
            let square =
                Square { file: (at.x + 3.5).round() as i8, rank: (3.5 - at.z).round() as i8 };
            let man = position.at(square).unwrap_or_else(|| panic!("move {number}: {square}"));
            assert_eq!((man.side as usize, man.kind as usize), (piece.side, piece.kind));
            assert_eq!(at.y, 0.0);
            standing += 1;
        }
        assert_eq!(standing, squares().filter(|&square| position.at(square).is_some()).count());
    }
    assert_eq!([SIDES[0], KINDS[2]], ["white", &Kind::Knight.to_string()]);
}

#[test]
fn the_tool_writes_a_game_of_ones_own_and_refuses_what_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let moves = folder.path().join("mine.txt");
    std::fs::write(&moves, "a2-a4\nb7-b5\na4-b5\na7-a6\nb5-a6\nc8-b7\na6-b7\nb8-c6\nb7-a8=N\n")
        .unwrap();
    let tool =
        |argument: &std::path::Path| run::command("chess_game").arg(argument).output().unwrap();
    assert!(tool(&moves).status.success());
    let legs = super::legs::open(&folder.path().join("mine.legs")).unwrap();
    // The pawn that captures the rook on a8 is a knight after its arrival.
    let kind = |frame| KINDS[legs.at(frame).nth(8).unwrap().kind];
    assert_eq!((kind(48 * 9 + 10 + 33), kind(48 * 9 + 10 + 34)), ("pawn", "knight"));
    assert_eq!(legs.last, 48 * 10 + 192);

    std::fs::write(&moves, "e2-e4\ne7-e5\ne4-e5\n").unwrap();
    let (code, line) = run::refusal(tool(&moves));
    assert!(
        code == 1 && line.ends_with(":3: the pawn on e4 cannot go to e5: it has no move here"),
        "{line}"
    );
    let (code, line) = refused("chess_game", &["samples/assets/chess.obj"]);
    assert!(code == 2 && line.contains("takes moves (.txt), --check, or nothing"), "{line}");
}

/// The numbers of move sequences used to test chess programs (perft), which depend on every rule.
#[test]
fn there_are_as_many_ways_to_begin_as_chess_has() {
    fn ways(position: &Position, depth: u32) -> u64 {
        if depth == 0 {
            return 1;
        }
        let mut count = 0;
        for from in squares() {
            for to in squares() {
                let mut after = position.clone();
                let by = Move { from, to, becomes: None };
                count += after.play(by).map_or(0, |_| ways(&after, depth - 1));
            }
        }
        count
    }
    let start = Position::start();
    assert_eq!([1, 2, 3].map(|depth| ways(&start, depth)), [20, 400, 8902]);
}

#[test]
fn every_square_has_its_name() {
    let mut names = String::new();
    squares().for_each(|square| write!(names, "{square}").unwrap());
    assert!(names.starts_with("a1b1c1") && names.ends_with("g8h8"), "{names}");
    assert_eq!(Kind::Knight.to_string(), "knight");
    assert_eq!(Square { file: 4, rank: 3 }.to_string(), "e4");
}
