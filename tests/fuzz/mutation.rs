//! Mutates inputs: changes, duplicates, removes and moves bytes, words and lines.

use reference::random::Random;

use crate::grammar::{ODD_NUMBERS, ODD_WORDS};

/// Changes an input in one to four places. `other` is an input to copy parts from, `words` are the words of
/// the format.
pub fn mutate(
    random: &mut Random,
    input: &[u8],
    other: &[u8],
    words: &[&str],
    most: usize,
) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..1 + random.below(4) {
        match random.below(3) {
            0 => by_bytes(random, &mut bytes, other),
            1 => by_parts(random, &mut bytes, words, most, is_of_word),
            _ => by_parts(random, &mut bytes, words, most, |byte| byte != b'\n'),
        }
        bytes.truncate(most);
    }
    bytes
}

/// A range of at most `most` elements within a length.
fn range(random: &mut Random, length: usize, most: usize) -> std::ops::Range<usize> {
    let start = random.below(length + 1);
    start..start + random.below((length - start).min(most) + 1)
}

fn by_bytes(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8]) {
    let length = bytes.len();
    match random.below(8) {
        0 if length > 0 => bytes[random.below(length)] ^= 1 << random.below(8),
        1 if length > 0 => bytes[random.below(length)] = random.bits() as u8,
        // Numbers of several bytes, in either byte order.
        2 if length >= 4 => {
            let odd = [0, 1, 0x7f, 0x80, 0xffff, 0x7fff_ffff, 0x8000_0000, u32::MAX, u32::MAX - 1];
            let odd = odd[random.below(odd.len())];
            let at = random.below(length - 3);
            let four = if random.below(2) == 0 { odd.to_le_bytes() } else { odd.to_be_bytes() };
            bytes[at..at + 4].copy_from_slice(&four);
        }
        3 => bytes.truncate(random.below(length + 1)),
        4 => drop(bytes.drain(range(random, length, 64))),
        5 => {
            let part = bytes[range(random, length, 64)].to_vec();
            let at = random.below(length + 1);
            bytes.splice(at..at, part);
        }
        // The beginning of one input and the end of the other.
        6 => {
            bytes.truncate(random.below(length + 1));
            bytes.extend(&other[random.below(other.len() + 1)..]);
        }
        _ => {
            let at = random.below(length + 1);
            let new: Vec<u8> = (0..1 + random.below(4)).map(|_| random.bits() as u8).collect();
            bytes.splice(at..at, new);
        }
    }
}

fn is_of_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || b"_.+-".contains(&byte) || byte >= 0x80
}

/// The parts that consist only of bytes of a kind.
fn parts(bytes: &[u8], is_of: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut parts = Vec::new();
    let mut start = None;
    for (at, &byte) in bytes.iter().enumerate() {
        match (start, is_of(byte)) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                parts.push(from..at);
                start = None;
            }
            _ => {}
        }
    }
    parts.extend(start.map(|from| from..bytes.len()));
    parts
}

fn by_parts(
    random: &mut Random,
    bytes: &mut Vec<u8>,
    words: &[&str],
    most: usize,
    is_of: impl Fn(u8) -> bool,
) {
    let parts = parts(bytes, is_of);
    if parts.is_empty() {
        return bytes.extend(b"1");
    }
    let [at, from] = [(); 2].map(|()| parts[random.below(parts.len())].clone());
    let taken = bytes[from].to_vec();
    match random.below(7) {
        0 => put(bytes, at, ODD_NUMBERS[random.below(ODD_NUMBERS.len())]),
        1 => put(bytes, at, ODD_WORDS[random.below(ODD_WORDS.len())]),
        2 if !words.is_empty() => put(bytes, at, words[random.below(words.len())]),
        3 => drop(bytes.drain(at)),
        4 => drop(bytes.splice(at.start..at.start, taken)),
        // Often enough to exceed a limit that counts repetitions.
        5 => {
            let end = (at.end + 1).min(bytes.len());
            let part = bytes[at.start..end].to_vec();
            let log = random.below(13);
            let times = (1 + random.below(1 << log)).min(most / part.len().max(1));
            bytes.splice(at.start..at.start, part.repeat(times));
        }
        _ => drop(bytes.splice(at, taken)),
    }
}

fn put(bytes: &mut Vec<u8>, at: std::ops::Range<usize>, word: &str) {
    bytes.splice(at, word.bytes());
}
