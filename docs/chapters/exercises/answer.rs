//! Whether an answer is right: by the words that matter in it, and not by every word.
//!
//! An alternative is a set of key words. An answer is read clause by clause, and the first clause that holds all
//! words of an alternative decides. What is denied there, as in "not red", does not count as said.

use super::interval::{Interval, number};

/// What answers a question, and what does not.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    /// Alternatives of which one is enough.
    pub right: Vec<String>,
    /// Alternatives of which one is too much.
    pub wrong: Vec<String>,
}

/// Words that deny all that is said beside them.
const DENY_ALL: [&str; 6] = ["never", "none", "nothing", "neither", "nor", "cannot"];
/// Words that deny what follows them.
const DENY_REST: [&str; 5] = ["not", "no", "than", "instead", "except"];
/// Where `not` follows one of these, it denies what stands before it, too.
const AUXILIARIES: [&str; 14] = [
    "is", "are", "was", "were", "do", "does", "did", "has", "have", "had", "can", "will", "would",
    "should",
];
/// Words that mean nothing here.
const ARTICLES: [&str; 3] = ["a", "an", "the"];
/// Words between two things that are said.
const BETWEEN: [&str; 5] = ["but", "and", "while", "whereas", "yet"];

impl Answers {
    /// The alternatives of two fields.
    pub fn of(right: &str, wrong: &str) -> Self {
        let all = |text: &str| {
            text.split('|').map(|one| one.trim().to_owned()).filter(|one| !one.is_empty()).collect()
        };
        Self { right: all(right), wrong: all(wrong) }
    }

    /// What is wrong with them: they do not take the book's own words, or take what is wrong.
    pub fn fault(&self, check: &str) -> Option<String> {
        if self.right.is_empty() {
            return None;
        }
        if !self.accept(check) {
            return Some("its own `Check` is not accepted as an answer".to_owned());
        }
        let taken = self.wrong.iter().find(|wrong| self.accept(wrong));
        taken.map(|wrong| format!("the wrong answer '{wrong}' is accepted"))
    }

    /// Whether an answer is right.
    pub fn accept(&self, answer: &str) -> bool {
        let whole = words(answer);
        if self.right.iter().any(|right| !whole.is_empty() && words(right) == whole) {
            return true;
        }
        clauses(answer).iter().find_map(|clause| self.judge(clause)).unwrap_or(false)
    }

    /// Whether a clause answers, and rightly; `None` if it does not answer.
    fn judge(&self, clause: &str) -> Option<bool> {
        let parts = parts(clause);
        let mut said: Vec<&str> = parts.iter().flat_map(|part| part.said()).collect();
        let intervals: Vec<Interval> = self.right.iter().filter_map(|one| interval(one)).collect();
        let numbers: Vec<f64> = said.iter().filter_map(|word| value(word)).collect();
        if !intervals.is_empty() && !numbers.is_empty() {
            // Every number must fit: who names two has not decided.
            let fits = |number: &f64| intervals.iter().any(|amount| amount.holds(*number));
            return Some(numbers.iter().all(fits) && !self.is_wrong(&parts, &said));
        }
        let keys = self.right.iter().filter(|one| interval(one).is_none()).map(|one| words(one));
        let held = keys.filter(|keys| holds(&parts, &said, keys));
        let longest = held.max_by_key(Vec::len);
        // `random` is wrong where `naive random` is right, and only where it stands alone.
        for key in longest.iter().flatten() {
            if let Some(at) = said.iter().position(|word| word == key) {
                said.remove(at);
            }
        }
        match (self.is_wrong(&parts, &said), longest) {
            (true, _) => Some(false),
            (false, Some(_)) => Some(true),
            (false, None) => None,
        }
    }

    fn is_wrong(&self, parts: &[Part], said: &[&str]) -> bool {
        self.wrong.iter().any(|wrong| holds(parts, said, &words(wrong)))
    }
}

/// Whether all key words are said; what denies must be said in one part.
fn holds(parts: &[Part], said: &[&str], keys: &[String]) -> bool {
    let in_part = |part: &Part| match keys {
        // "No" is an answer, "no idea" is none.
        [only] if DENY_REST.contains(&&**only) => part.words.len() == 1 && part.words[0] == *only,
        _ => keys.iter().all(|key| part.words.contains(key)),
    };
    match keys.iter().any(|key| denies(key)) {
        true => parts.iter().any(in_part),
        false => !keys.is_empty() && keys.iter().all(|key| said.contains(&&**key)),
    }
}

/// A part of a clause, in which a denial holds.
struct Part {
    words: Vec<String>,
}

impl Part {
    /// The words that are not denied.
    fn said(&self) -> Vec<&str> {
        let all = || self.words.iter().map(|word| &**word);
        let Some(at) = self.words.iter().position(|word| denies(word)) else {
            return all().collect();
        };
        let before = at.checked_sub(1).map_or("", |before| &self.words[before]);
        let alone = DENY_REST.contains(&&*self.words[at]) && !AUXILIARIES.contains(&before);
        all().take(if alone { at } else { 0 }).collect()
    }
}

fn denies(word: &str) -> bool {
    DENY_ALL.contains(&word) || DENY_REST.contains(&word) || word.ends_with("n't")
}

/// The clauses of a text, in its order.
fn clauses(text: &str) -> Vec<String> {
    let mut clauses = vec![String::new()];
    for word in text.split_whitespace() {
        let ends = word.ends_with(['.', ';', ':', '!', '?']);
        if let Some(last) = clauses.last_mut() {
            last.push_str(word.trim_end_matches(['.', ';', ':', '!', '?']));
            last.push(' ');
        }
        if ends {
            clauses.push(String::new());
        }
    }
    clauses
}

/// The parts of a clause.
fn parts(clause: &str) -> Vec<Part> {
    let mut parts = vec![Vec::new()];
    for word in clause.split_whitespace() {
        let plain = words(word);
        if plain.iter().any(|word| BETWEEN.contains(&&**word)) {
            parts.push(Vec::new());
        } else if let Some(last) = parts.last_mut() {
            last.extend(plain);
        }
        if word.ends_with(',') {
            parts.push(Vec::new());
        }
    }
    parts.into_iter().filter(|words| !words.is_empty()).map(|words| Part { words }).collect()
}

/// The words of a text in small letters and the singular, without articles and what stands around them.
fn words(text: &str) -> Vec<String> {
    let text = text.to_lowercase().replace('−', "-").replace('’', "'");
    let split = text.split_whitespace().flat_map(|word| {
        let compound =
            word.contains('-') && !word.contains(|c: char| c.is_ascii_digit() || c == '=');
        word.split(if compound && !word.starts_with('-') { '-' } else { ' ' })
    });
    let plain = split.map(|word| {
        let word = word.trim_start_matches(|c: char| !c.is_alphanumeric() && !"+-".contains(c));
        let word = word.trim_end_matches(|c: char| !c.is_alphanumeric());
        singular(word.trim_end_matches("'s"))
    });
    plain.filter(|word| !word.is_empty() && !ARTICLES.contains(&&**word)).collect()
}

/// A word without the `s` of a plural or of a verb.
fn singular(word: &str) -> String {
    let long = ["xes", "oes", "shes", "ches", "sses"].iter().any(|end| word.ends_with(end));
    let short = word.ends_with('s') && !word.ends_with("ss") && word.len() > 3;
    word[..word.len() - if long && word.len() > 4 { 2 } else { usize::from(short) }].to_owned()
}

fn value(word: &str) -> Option<f64> {
    if word == "zero" { Some(0.0) } else { number(word) }
}

fn interval(alternative: &str) -> Option<Interval> {
    Interval::exactly(&alternative.split_whitespace().collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accepted(right: &str, wrong: &str, answers: &[&str]) -> Vec<bool> {
        let of = Answers::of(right, wrong);
        answers.iter().map(|answer| of.accept(answer)).collect()
    }

    #[test]
    fn what_matters_is_found_in_any_order_and_form() {
        let right = ["up", "Up.", "+y", "White  King", "the king is white", "it looks up, I think"];
        assert_eq!(accepted("up | +y | the white king", "down", &right), [true; 6]);
        let touch =
            ["at the edge where the squares touch", "where they touch", "the touching edges"];
        assert_eq!(accepted("edge | touch", "middle", &touch), [true; 3]);
        let wrong = ["", "king", "y", "the", "down"];
        assert_eq!(accepted("up | +y | the white king", "down", &wrong), [false; 5]);
    }

    #[test]
    fn what_is_denied_is_not_said() {
        let wrong = ["not red", "it is not red", "it isn't red", "red is not seen", "never red"];
        assert_eq!(accepted("red", "black", &wrong), [false; 5]);
        let right = ["it is red", "red, not black", "not black but red", "red and not black"];
        assert_eq!(accepted("red", "black", &right), [true; 4]);
        let none = ["no", "no idea", "not sure", "no, none differs", "none", "nothing differs"];
        let expected = [true, false, false, true, true, false];
        assert_eq!(accepted("no | none", "yes", &none), expected);
    }

    #[test]
    fn who_says_both_has_not_answered() {
        let both = ["along x or Morton", "x, Morton", "Morton. Along x", "Morton and x"];
        assert_eq!(accepted("along x | x", "Morton", &both), [false; 4]);
        let own = ["naive random", "`naive random`. In `random` nothing changes.", "random"];
        assert_eq!(accepted("naive random | naive", "random", &own), [true, true, false]);
    }

    #[test]
    fn numbers_are_compared_as_numbers() {
        let right =
            ["40", "44.0", "42.5", "about 42 frames", "about 42: 16 are too few", "1,600", "1600"];
        assert_eq!(accepted("40 to 44 | 1,600", "", &right), [true; 7]);
        let wrong = ["39", "45", "42 or 45", "40 to 50", "no"];
        assert_eq!(accepted("40 to 44", "", &wrong), [false; 5]);
        assert_eq!(accepted("0 | none", "", &["zero", "0 bytes", "none differ"]), [true; 3]);
    }
}
