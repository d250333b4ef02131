//! Whether an answer is right: by the words that matter in it, and not by every word.
//!
//! An alternative is a set of key words. An answer is read clause by clause, and the first clause that holds all
//! words of an alternative decides. What is denied there, as in "not red", does not count as said. Where an
//! alternative has commas, its sets are said one after the other, each in a part of its own.

use super::clause::{Part, clauses, denies, parts, words};
use super::interval::{Interval, number};

/// What answers a question, and what does not.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    /// Alternatives of which one is enough.
    pub right: Vec<String>,
    /// Alternatives of which one is too much.
    pub wrong: Vec<String>,
}

/// Key words: sets that are said one after the other.
type Keys = Vec<Vec<String>>;

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
        let numbers = numbers(clause);
        if !intervals.is_empty() && !numbers.is_empty() {
            // Every number must fit: who names two has not decided.
            let fits = |number: &f64| intervals.iter().any(|amount| amount.holds(*number));
            return Some(numbers.iter().all(fits) && !self.is_wrong(&parts, &said, 0));
        }
        let all = self.right.iter().filter(|one| interval(one).is_none()).map(|one| keys(one));
        let held = all.filter(|keys| holds(&parts, &said, keys));
        let longest = held.max_by_key(length);
        // `wide foot` is wrong where `foot` is right, for it says more.
        let length = longest.as_ref().map_or(0, length);
        let mut wrong = self.is_wrong(&parts, &said, length);
        // `random` is wrong where `naive random` is right, and only where it stands alone.
        for key in longest.iter().flatten().flatten() {
            if let Some(at) = said.iter().position(|word| word == key) {
                said.remove(at);
            }
        }
        wrong |= self.is_wrong(&parts, &said, 0);
        (wrong || longest.is_some()).then_some(!wrong)
    }

    /// Whether a wrong alternative of more than some words is said.
    fn is_wrong(&self, parts: &[Part], said: &[&str], words: usize) -> bool {
        let all = self.wrong.iter().map(|wrong| keys(wrong));
        all.filter(|wrong| length(wrong) > words).any(|wrong| holds(parts, said, &wrong))
    }
}

fn length(keys: &Keys) -> usize {
    keys.iter().flatten().count()
}

/// The key words of an alternative.
fn keys(alternative: &str) -> Keys {
    let sets = alternative.split(", ").map(words);
    sets.filter(|set| !set.is_empty()).collect()
}

/// Whether all key words are said; what denies must be said in one part.
fn holds(parts: &[Part], said: &[&str], keys: &Keys) -> bool {
    match &keys[..] {
        [set] if !set.iter().any(|key| denies(key)) => set.iter().all(|key| said.contains(&&**key)),
        sets => {
            let mut parts = parts.iter();
            !sets.is_empty() && sets.iter().all(|set| parts.any(|part| part.holds(set)))
        }
    }
}

/// The numbers that a clause says: of a sum what it comes to, behind the last `=`.
fn numbers(clause: &str) -> Vec<f64> {
    let result = parts(clause.rsplit('=').next().unwrap_or(clause));
    result.iter().flat_map(Part::said).filter_map(value).collect()
}

fn value(word: &str) -> Option<f64> {
    if word == "zero" { Some(0.0) } else { number(word) }
}

fn interval(alternative: &str) -> Option<Interval> {
    Interval::exactly(&alternative.split_whitespace().collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use manuscript::project::Project;

    use super::super::exercise::{Exercise, Takes};
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
    fn the_first_of_two_decides_where_one_comes_after_the_other() {
        let right = ["small", "first the small, then the large", "small, while large ones stay"];
        assert_eq!(accepted("small", "large", &right), [true; 3]);
        let wrong = ["first the large, then the small", "the large before the small"];
        assert_eq!(accepted("small", "large", &wrong), [false; 2]);
        let sides = ["white inside, black outside", "black outside, white inside", "foot, no"];
        assert_eq!(accepted("white inside, black", "outside", &sides), [false; 3]);
        let whole = accepted("inside | white inside, black outside", "outside", &sides);
        assert_eq!(whole, [true, false, false]);
        let foot = ["at the foot", "wide at the foot", "does not end at the foot"];
        assert_eq!(accepted("foot", "wide foot", &foot), [true, false, false]);
    }

    #[test]
    fn numbers_are_compared_as_numbers() {
        let right =
            ["40", "44.0", "42.5", "about 42 frames", "about 42: 16 are too few", "1,600", "1600"];
        assert_eq!(accepted("40 to 44 | 1,600", "", &right), [true; 7]);
        let wrong = ["39", "45", "42 or 45", "40 to 50", "no"];
        assert_eq!(accepted("40 to 44", "", &wrong), [false; 5]);
        assert_eq!(accepted("0 | none", "", &["zero", "0 bytes", "none differ"]), [true; 3]);
        let result = ["opacity=0.4", "1 - 0.6 = 0.4", "0.6 = 1 - 0.4"];
        assert_eq!(accepted("0.4", "", &result), [true, true, false]);
    }

    #[test]
    fn what_readers_say_is_judged_as_in_the_list() {
        let tool = Path::new(env!("CARGO_MANIFEST_DIR"));
        let project = Project::open(tool.ancestors().nth(2).unwrap()).unwrap();
        let list = project.read("tests/data/answers.txt").unwrap();
        let told = list.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let told: Vec<&str> = told.collect();
        for exercise in Exercise::whole(&project).unwrap() {
            for (sign, right) in [("+", true), ("-", false)] {
                let start = format!("{exercise} {sign} ");
                let own = told.iter().find_map(|line| line.strip_prefix(&start));
                assert_eq!(own.is_some(), exercise.takes == Takes::Look, "{start}");
                for answer in own.into_iter().flat_map(|own| own.split(" / ")) {
                    assert_eq!(exercise.answers.accept(answer), right, "{exercise}: {answer}");
                }
            }
        }
    }
}
