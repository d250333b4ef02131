//! Words of the variable `MOODS`.

use std::str::FromStr;

/// Tests whether the variable holds a word.
pub fn has(word: &str) -> bool {
    words().iter().any(|own| own == word)
}

/// The value after `word=` in the variable.
///
/// # Panics
/// If it is no value of that type.
pub fn value<T: FromStr>(word: &str) -> Option<T> {
    let words = words();
    let text = words.iter().find_map(|own| own.strip_prefix(word)?.strip_prefix('='))?;
    Some(text.parse().unwrap_or_else(|_| panic!("MOODS: {word}={text}")))
}

fn words() -> Vec<String> {
    let words = std::env::var("MOODS").unwrap_or_default();
    words.split(',').map(str::to_owned).collect()
}
