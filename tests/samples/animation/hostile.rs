//! Invalid files of legs: each fault is reported in one line, with the line's number.

use run::refused;

use super::{NAME, legs};

/// Reads such a file: the numbers of pieces and legs, or the message.
fn read(text: &[u8]) -> Result<(usize, usize), String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("g.legs");
    std::fs::write(&path, text).unwrap();
    let read = legs::open(&path).map_err(|error| format!("{error:#}"));
    let count = |motion: super::Motion| {
        (motion.pieces.len(), motion.pieces.iter().map(|piece| piece.legs.len()).sum())
    };
    read.map(count).map_err(|line| line.replace(&path.display().to_string(), "g.legs"))
}

#[test]
fn legs_are_read_with_comments_and_any_line_ends() {
    let text = "\u{feff}# so\r\nlast 100\r\n\r\npiece white pawn 0 0 0 # so\r\nleg 0 0 1 0 0 0\r\n\
                leg 34 0 1 0 1 2.3 queen#too";
    assert_eq!(read(text.as_bytes()), Ok((1, 2)));
}

#[test]
fn a_line_that_is_wrong_is_refused_with_what_would_be_right() {
    let lines = "a line is 'last FRAME', 'piece SIDE KIND X Y Z', or 'leg FRAME PIECE X Y Z LIFT'";
    for (line, told) in [
        ("e2-e4", lines),
        ("last", lines),
        ("last 100 200", lines),
        ("piece white pawn 0 0", lines),
        ("leg 0 0 1 0 0", lines),
        ("leg 0 0 1 0 0 0 queen rook", lines),
        ("last 0", "\"0\" is no number from 1 to 36000"),
        ("last 36001", "\"36001\" is no number from 1 to 36000"),
        ("piece red pawn 0 0 0", "\"red\" is none of white, black"),
        ("piece white pwn 0 0 0", "\"pwn\" is none of pawn, rook, knight, bishop, queen, king"),
        ("piece white pawn 0 nan 0", "\"nan\" is no number from -100 to 100"),
        ("piece white pawn 0 0 -101", "\"-101\" is no number from -100 to 100"),
        ("leg 101 0 1 0 0 0", "\"101\" is no number from 0 to 100"),
        ("leg -1 0 1 0 0 0", "\"-1\" is no number from 0 to 100"),
        ("leg 0 1 1 0 0 0", "there is no piece 1: 1 stand above"),
        ("leg 0 4294967296 1 0 0 0", "\"4294967296\" is no number from 0 to 255"),
        ("leg 0 0 1 0 inf 0", "\"inf\" is no number from -100 to 100"),
        ("leg 0 0 1 0 0 -1", "\"-1\" is no number from 0 to 100"),
        ("leg 0 0 1 0 0 0 =Q", "\"=Q\" is none of pawn"),
        ("leg 60 0 1 0 0 0\nleg 93 0 1 0 0 0", "piece 0 is under way until frame 94"),
        ("leg 60 0 1 0 0 0\nleg 10 0 1 0 0 0", "piece 0 is under way until frame 94"),
    ] {
        let text = format!("last 100\npiece white pawn 0 0 0\n{line}\n");
        let refused = read(text.as_bytes()).unwrap_err();
        let number = text.lines().count();
        assert!(refused.starts_with(&format!("g.legs:{number}: {told}")), "{line:?}: {refused}");
    }
}

#[test]
fn a_file_that_holds_no_legs_is_refused_in_one_line() {
    let pieces = "piece white pawn 0 0 0\n".repeat(257);
    let long = [&b"last 100\n"[..], &[b'x'; 10_000], b"\n"].concat();
    for (text, words) in [
        (&b""[..], "g.legs: there is no last frame in it, or no piece, such as 'last 240' and"),
        (b"last 100\n", "there is no last frame in it, or no piece"),
        (b"piece white pawn 0 0 0\n", "there is no last frame in it, or no piece"),
        (b"piece white pawn 0 0 0\nleg 1 0 0 0 0 0\n", "g.legs:2: \"1\" is no number from 0 to 0"),
        (b"last 100\n\0\n", "g.legs:2: holds a zero byte"),
        (b"\xff\xfe\xff\n", "g.legs:1: this is UTF-16 text; save it as UTF-8"),
        (b"last 100\npiece whi", "the piece becomes another; the file ends in this line"),
        (&long, "g.legs:2: a line is"),
        (pieces.as_bytes(), "g.legs:257: more than 256 pieces"),
        (&[b'#'; 70_000], "is too large: 70000 bytes, at most 65536 are read"),
    ] {
        let refused = read(text).unwrap_err();
        assert!(refused.contains(words) && refused.len() < 300, "{refused}");
        assert_eq!(refused.lines().count(), 1);
    }
}

#[test]
fn the_sample_says_so_and_takes_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("g.legs");
    std::fs::write(&file, "last 100\npiece white king 0.5 0 3.5\nleg 0 1 0.5 0 2.5 0\n").unwrap();
    let (code, line) = refused(NAME, &["--headless", "--scene", file.to_str().unwrap()]);
    assert!(code == 1 && line.ends_with("g.legs:3: there is no piece 1: 1 stand above"), "{line}");
    let (code, line) = refused(NAME, &["--headless", "--scene", "samples/assets/games/opera.txt"]);
    assert!(
        code == 2 && line.contains("takes legs of pieces (.legs), which chess_game makes"),
        "{line}"
    );
    let (code, line) = refused(NAME, &["--headless", "--scene", "nowhere.legs"]);
    assert!(code == 1 && line.contains("nowhere.legs: there is no such file"), "{line}");
    let (code, line) = refused(NAME, &["--headless", "--set", "frame=1825"]);
    assert!(code == 2 && line.contains("it takes a whole number from 0 to 1824"), "{line}");
}
