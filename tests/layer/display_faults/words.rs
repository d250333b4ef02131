//! Words of the variable `DISPLAY_FAULTS`.

use std::str::FromStr;

/// Returns whether the variable contains a word.
pub fn has(word: &str) -> bool {
    words().iter().any(|own| own == word)
}

/// The value after `word=` in the variable.
///
/// # Panics
/// If the value cannot be parsed as that type.
pub fn value<T: FromStr>(word: &str) -> Option<T> {
    let words = words();
    let text = words.iter().find_map(|own| own.strip_prefix(word)?.strip_prefix('='))?;
    Some(text.parse().unwrap_or_else(|_| panic!("DISPLAY_FAULTS: {word}={text}")))
}

fn words() -> Vec<String> {
    let words = std::env::var("DISPLAY_FAULTS").unwrap_or_default();
    words.split(',').map(str::to_owned).collect()
}
