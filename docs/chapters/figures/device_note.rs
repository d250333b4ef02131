//! Notes: where a page says which device gave its figures, and when.
//!
//! A note begins with the device's name and ends with the day:
//! `llvmpipe (LLVM 15.0.6, 256 bits), Mesa 25.0.7, 2026-11-22`.

use std::ops::Range;

use super::record::Record;

/// How long `2026-11-22` is.
pub const DAY: usize = 10;

/// The notes in parts of a text; `devices` are the first words of devices' names.
pub fn found(text: &str, parts: &[Range<usize>], devices: &[&str]) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    for part in parts {
        for device in devices {
            for (at, _) in text[part.clone()].match_indices(device) {
                let start = part.start + at;
                let rest = &text[start..part.end];
                let ends = [". ", "; "].into_iter().filter_map(|end| rest.find(end));
                let clause = &rest[..ends.min().unwrap_or(rest.len())];
                found.extend(day(clause).map(|day| start..start + day + DAY));
            }
        }
    }
    found.sort_by_key(|span| span.start);
    found.dedup();
    found
}

/// Where the first day stands in a text.
fn day(text: &str) -> Option<usize> {
    let is_day = |at: &usize| {
        let Some(day) = text.get(*at..at + DAY) else { return false };
        day.bytes().enumerate().all(|(index, byte)| match index {
            4 | 7 => byte == b'-',
            _ => byte.is_ascii_digit(),
        })
    };
    (0..text.len()).find(is_day)
}

/// What a note should say at most.
pub fn told(stored: &Record) -> String {
    format!("{}, {}, {}", stored.device, stored.driver, stored.date)
}

/// The first word of a note that is neither the device's nor the driver's nor the day.
pub fn unknown_word<'a>(note: &'a str, stored: &Record) -> Option<&'a str> {
    let told = told(stored);
    let known: Vec<&str> = words(&told).collect();
    // A driver's version is that of its package: 25.0.7-2 is Mesa 25.0.7.
    let is_known = |word: &&str| {
        known.iter().any(|known| known == word || known.split('-').next() == Some(word))
    };
    words(note).find(|word| !is_known(word))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    let between = |c: char| c.is_whitespace() || ['(', ')', ',', '~', ':'].contains(&c);
    text.split(between).filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTE: &str = "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 25.0.7, 2026-11-22";

    #[test]
    fn a_note_is_a_device_and_a_day() {
        let text = format!("At 480×300; {NOTE}, on two cores. On llvmpipe. On 2026-11-21");
        let [note] = &found(&text, std::slice::from_ref(&(0..text.len())), &["llvmpipe"])[..]
        else {
            panic!()
        };
        assert_eq!(&text[note.clone()], NOTE);
    }

    #[test]
    fn its_words_are_the_device_s_the_driver_s_and_the_day() {
        let text = r#"{ "command": "", "timed": false, "device": "llvmpipe (LLVM 15.0.6, 256 bits)",
            "driver": "llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)", "date": "2026-11-22",
            "sources": "", "values": {} }"#;
        let stored: Record = serde_json::from_str(text).unwrap();
        assert_eq!(unknown_word(NOTE, &stored), None);
        let cases = [("25.0.7", "25.0.8"), ("11-22", "11-21"), ("256", "128"), ("LLVM", "AVX")];
        for (from, to) in cases {
            let note = NOTE.replace(from, to);
            assert!(unknown_word(&note, &stored).is_some_and(|word| word.ends_with(to)), "{note}");
        }
    }
}
