//! The numbers after a keyword.

use super::text::quoted;

/// The words after a keyword, up to a comment.
///
/// A `#` begins a comment, but not within a number that older Windows programs wrote for a NaN: `-1.#IND`.
pub(crate) fn words(rest: &str) -> impl Iterator<Item = &str> {
    let mut ended = false;
    rest.split_whitespace().map_while(move |word| {
        let is_comment = |at: &usize| {
            !(word[..*at].ends_with('.')
                && word[at + 1..].starts_with(|c: char| c.is_ascii_uppercase()))
        };
        let comment = word.match_indices('#').map(|(at, _)| at).find(is_comment);
        let word = &word[..comment.unwrap_or(word.len())];
        let word = (!ended && !word.is_empty()).then_some(word);
        ended = comment.is_some();
        word
    })
}

/// Reads the numbers after a keyword into `values` and returns how many there are; those for which `values` has no
/// room are only counted.
///
/// # Errors
/// If one is not a number or not finite. Text, which is cheap: an error may capture a backtrace for each of a
/// million lines.
pub(crate) fn numbers(keyword: &str, rest: &str, values: &mut [f32]) -> Result<usize, String> {
    let mut count = 0;
    for word in words(rest) {
        if let Some(value) = values.get_mut(count) {
            *value =
                number(word).map_err(|why| format!("{keyword} has {}, {why}", quoted(word)))?;
        }
        count += 1;
    }
    Ok(count)
}

fn number(word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => return Ok(value),
        Err(_) if !word.contains('#') => {}
        _ => return Err("which is not a finite 32-bit number".to_owned()),
    }
    let point = word.replacen(',', ".", 1);
    Err(match point.parse::<f32>() {
        Ok(_) => format!("which is not a number; write {point}"),
        Err(_) => "which is not a number".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_ends_the_numbers() {
        let read = |rest: &str| words(rest).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(read("1 2# 3"), ["1", "2"]);
        assert_eq!(read("1 # 2 3"), ["1"]);
        assert_eq!(read("#"), [""; 0]);
        assert_eq!(read("-1.#IND 1.#QNAN00 2.#x 3"), ["-1.#IND", "1.#QNAN00", "2."]);
    }

    #[test]
    fn what_is_no_number_is_named_with_its_keyword() {
        let wrong = |rest: &str| numbers("Kd", rest, &mut [0.0; 3]).unwrap_err();
        assert_eq!(wrong("1 red"), "Kd has \"red\", which is not a number");
        assert_eq!(wrong("1,5 0 0"), "Kd has \"1,5\", which is not a number; write 1.5");
        for nan in ["nan", "-nan", "inf", "1e39", "-1.#IND", "1.#QNAN", "1.#J"] {
            let words = format!("Kd has {nan:?}, which is not a finite 32-bit number");
            assert_eq!(wrong(nan), words);
        }
        let mut values = [0.0; 2];
        assert_eq!(numbers("Kd", "1 2 three", &mut values), Ok(3));
        assert_eq!(values, [1.0, 2.0]);
    }
}
