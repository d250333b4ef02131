//! Text of other encodings.

use super::*;

#[test]
fn names_are_equal_only_if_their_bytes_are() {
    let red: &[u8] = b"\x8d\x95";
    // One that would represent the first byte of `red` if it were not decomposed.
    let private = "\u{10ff8d}\u{10ff95}".as_bytes();
    let names = [
        red,
        b"\x94\x92",
        b"\xef\xbf\xbd\xef\xbf\xbd",
        private,
        b"\\x8D\\x95",
        "é".as_bytes(),
        b"\xe9",
    ];
    for (number, name) in names.iter().enumerate() {
        let text = letters(name);
        #[cfg(unix)]
        assert_eq!(path_letters(&path(&text)), text);
        assert!(names[..number].iter().all(|other| letters(other) != text), "{text:?}");
    }
    assert_eq!(quoted(&letters(b"caf\xe9 \"1\"\\\n")), r#""caf\xE9 \"1\"\\\n""#);
    assert_eq!(quoted(&letters(names[4])), r#""\\x8D\\x95""#);
}

#[test]
fn text_that_is_not_utf_8_is_named_with_its_line() {
    let wide = |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_le_bytes).collect() };
    let big = |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_be_bytes).collect() };
    let text = "v 0 0 0\nv 1 0 0\n";
    let utf16 = "f:1: this is UTF-16 text; save it as UTF-8";
    for (bytes, words) in [
        (wide(&format!("\u{feff}{text}")), utf16),
        (big(&format!("\u{feff}{text}")), utf16),
        (wide(text), utf16),
        (big(text), utf16),
        (wide("v"), utf16),
        (b"\xff\xfe\0\0v\0\0\0".to_vec(), "f:1: this is UTF-32 text; save it as UTF-8"),
        (b"a\nb\0c\0".to_vec(), "f:2: holds a zero byte: this is a binary file, not text"),
        (
            b"a\ncaf\xe9\n".to_vec(),
            "f:2: the byte 0xE9 is not UTF-8, but perhaps Latin-1; save the file as UTF-8",
        ),
    ] {
        assert_eq!(utf8(bytes, "f").unwrap_err().to_string(), words);
    }
    assert_eq!(utf8(b"\xef\xbb\xbfcaf\xc3\xa9".to_vec(), "f").unwrap(), "café");
    assert_eq!(utf8(Vec::new(), "f").unwrap(), "");
}
