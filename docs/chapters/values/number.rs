//! Parses the numbers in a page's text, and formats values in the same way.

use std::ops::Range;
use std::sync::LazyLock;

use regex_lite::Regex;

/// The readings of a text; the first that matches wins. Only the groups named in [`found`] are numbers.
static TEXT: LazyLock<Regex> = LazyLock::new(|| {
    let parts = [
        // A date.
        r"\d{4}-\d\d-\d\d",
        // An ordinal, not a quantity.
        r"(?i:chapters?|exercises?|sections?|parts?|row|column|location|binding|set) \d+(?:(?:, | and | to )\d{1,2}\b)*",
        // A version.
        r"(?:Vulkan|SPIR-V|LLVM|Mesa|Debian|Ubuntu|Rust|RDNA) \d+(?:\.\d+)*",
        r"\d+(?:\.\d+){2,}",
        // A size.
        r"\d+[×x]\d+",
        // A number with an exponent.
        r"(?P<power>\d+(?:\.\d+)?e-?\d+)",
        // A word: `R2`, `RDNA3`, `32-bit`, `100,000th`.
        r"[A-Za-z_][A-Za-z_0-9-]*",
        r"\d[\d,.]*-?[A-Za-z_][A-Za-z_0-9-]*",
        // A chapter's number.
        r"0\d+",
        r"(?P<plain>(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?)",
    ];
    Regex::new(&parts.join("|")).expect("the pattern is right")
});

/// A number in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Number {
    /// Its range, in bytes.
    pub span: Range<usize>,
    /// Its text.
    pub written: String,
    /// True if it has a minus sign.
    negative: bool,
    /// The unit of its value: hundredths for a percent sign, millions for that word and for MB.
    scale: Scale,
    /// True if it is approximate; then its trailing zeros are not significant.
    about: bool,
}

/// The unit after a number, which is part of its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scale {
    One,
    Percent,
    Million,
}

/// Every number in a part of a text that is not part of a name and not an ordinal.
pub fn found(text: &str, part: Range<usize>) -> Vec<Number> {
    let captures = TEXT.captures_iter(&text[part.clone()]);
    let groups =
        captures.filter_map(|found| ["power", "plain"].iter().find_map(|name| found.name(name)));
    let number = |found: regex_lite::Match| {
        let span = part.start + found.start()..part.start + found.end();
        let (before, after) = (&text[..span.start], &text[span.end..]);
        // The comment that binds it belongs to the number, not to the text after it.
        let comment = after.strip_prefix("<!--").and_then(|rest| Some(rest.split_once("-->")?.1));
        let after = comment.unwrap_or(after).trim_start_matches(' ');
        let word =
            after.split([' ', ',', '.', ';', ':', ')', '|', '\n']).next().unwrap_or_default();
        let written = found.as_str().to_owned();
        // The hyphen of a range is not a minus sign: 5-7.
        let minus = before.strip_suffix(['-', '−']);
        let negative = minus.is_some_and(|before| !before.ends_with(|c: char| c.is_alphanumeric()));
        let scale = match word {
            "%" => Scale::Percent,
            "million" | "MB" => Scale::Million,
            _ => Scale::One,
        };
        Number { about: before.ends_with("about "), negative, span, written, scale }
    };
    groups.map(number).collect()
}

impl Number {
    /// True for four digits that may be a year.
    pub fn is_year(&self) -> bool {
        self.written.len() == 4 && ["19", "20"].contains(&&self.written[..2])
    }

    /// Formats a value like this number: rounded to its digits, with its separators and its exponent.
    pub fn like(&self, value: f64) -> String {
        let value = if self.negative { -value } else { value };
        let value = match self.scale {
            Scale::One => value,
            Scale::Percent => 100.0 * value,
            Scale::Million => value / 1e6,
        };
        let digits = self.written.replace(',', "");
        let (mantissa, exponent) =
            digits.split_once('e').map_or((&*digits, None), |(m, e)| (m, Some(e)));
        let places = mantissa.split_once('.').map_or(0, |(_, places)| places.len());
        if exponent.is_some() {
            return format!("{value:.places$e}");
        }
        let zeros = digits.len() - digits.trim_end_matches('0').len();
        if self.about && places == 0 && zeros > 0 && zeros < digits.len() {
            let unit = 10f64.powi(zeros as i32);
            return self.separated(&format!("{:.0}", (value / unit).round() * unit));
        }
        self.separated(&format!("{value:.places$}"))
    }

    /// Groups digits by three, unless this number has four or more digits without separators.
    fn separated(&self, text: &str) -> String {
        let (whole, rest) = text.split_at(text.find('.').unwrap_or(text.len()));
        let own = self.written.split('.').next().unwrap_or_default();
        if whole.len() < 4 || own.len() >= 4 && !own.contains(',') {
            return text.to_owned();
        }
        let digit = |(index, digit): (usize, char)| {
            let comma =
                index > 0 && (whole.len() - index) % 3 == 0 && whole.is_char_boundary(index);
            comma.then_some(',').into_iter().chain([digit])
        };
        whole.chars().enumerate().flat_map(digit).chain(rest.chars()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<Number> {
        found(text, 0..text.len())
    }

    fn written(text: &str) -> String {
        all(text).into_iter().map(|number| number.written).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn names_and_the_numbers_of_things_are_not_numbers() {
        let cases = [
            ("Of 59,050 pixels 26,950 go dark, 12 not, 13 do.", "59,050 26,950 12 13"),
            ("off by 3.2e-7, 2.8 at 5 %, × 3, 4 ms, 4 rays, −4", "3.2e-7 2.8 5 3 4 4 4"),
            ("In 02, chapter 24, chapters 1 to 30 and exercise 14, 2026-11-22", ""),
            ("Mesa 25.0.7 (LLVM 15), Vulkan 1.2 at 480×300 in 32-bit floats", ""),
            ("R2 of Welford 1962, RDNA3, p99, the 10,000th, gfx1201", "1962"),
            ("1,997 or 31 million in 1989.2 ms of 1989.", "1,997 31 1989.2 1989"),
        ];
        for (text, expected) in cases {
            assert_eq!(written(text), expected, "{text}");
        }
    }

    #[test]
    fn values_are_rounded_to_the_digits_of_the_page() {
        let cases = [
            ("1.02", 1.0199, "1.02"),
            ("59,050", 59050.0, "59,050"),
            ("30218", 30219.0, "30219"),
            ("999", 1234567.0, "1,234,567"),
            ("2,097,152.5", 1e3, "1,000.0"),
            ("3.2e-7", 3.1999e-7, "3.2e-7"),
            ("0.6 %", 0.005_96, "0.6"),
            ("31 million", 30.6e6, "31"),
            ("31<!-- a.b --> million", 30.6e6, "31"),
            ("about 120 ms", 117.6, "120"),
            ("about 2,000", 1_951.0, "2,000"),
            ("2,000", 1_951.0, "1,951"),
            ("0", 0.0, "0"),
            ("−0.50", -0.498, "0.50"),
            ("−0.50", 0.498, "-0.50"),
        ];
        for (text, value, expected) in cases {
            assert_eq!(all(text)[0].like(value), expected, "{text}");
        }
    }
}
