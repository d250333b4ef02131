//! The answer to an exercise that needs no edits: a number, or one of the words listed in the question.

use super::interval::{Interval, number};

/// The number of words a question may list.
const WORDS: std::ops::RangeInclusive<usize> = 2..=4;

/// The right answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// A number in this range.
    Number(Interval),
    /// One of the listed words.
    Word {
        /// All of them, in the question's order.
        choices: Vec<String>,
        /// The index of the right one.
        right: usize,
    },
}

impl Answer {
    /// Reads the fields `Answer` and `Choices` of an exercise whose question is `text`.
    ///
    /// # Errors
    /// The fault of the fields.
    pub fn parse(answer: &str, choices: Option<&str>, text: &str) -> Result<Self, String> {
        let Some(choices) = choices else {
            let interval = Interval::exactly(&answer.split_whitespace().collect::<Vec<_>>());
            let not = || format!("'{answer}' is not a number, and no `Choices` are listed");
            return interval.map(Self::Number).ok_or_else(not);
        };
        let choices: Vec<String> = choices.split('|').map(|word| word.trim().to_owned()).collect();
        if !WORDS.contains(&choices.len()) {
            return Err(format!("`Choices` lists {}, not two to four", choices.len()));
        }
        if let Some(word) = choices.iter().find(|word| word.is_empty() || !text.contains(&**word)) {
            return Err(format!("the question does not name the choice '{word}'"));
        }
        let mut is_answer = choices.iter().map(|word| same(word, answer));
        match (is_answer.position(|is| is), is_answer.any(|is| is)) {
            (Some(right), false) => Ok(Self::Word { choices, right }),
            (Some(_), true) => Err(format!("`Choices` lists '{answer}' twice")),
            (None, _) => Err(format!("`Choices` does not list the answer '{answer}'")),
        }
    }

    /// Returns whether an answer is right.
    ///
    /// # Errors
    /// If it is neither a number nor a listed word; the message says which of them the question accepts.
    pub fn accept(&self, given: &str) -> Result<bool, String> {
        match self {
            Self::Number(interval) => {
                let number = number(given.trim());
                number.map(|number| interval.holds(number)).ok_or_else(|| self.form())
            }
            Self::Word { choices, right } => {
                let index = choices.iter().position(|word| same(word, given));
                index.map(|index| index == *right).ok_or_else(|| self.form())
            }
        }
    }

    /// Describes the answers that the question accepts.
    pub fn form(&self) -> String {
        match self {
            Self::Number(_) => "a number".to_owned(),
            Self::Word { choices, .. } => {
                let quoted: Vec<String> = choices.iter().map(|word| format!("'{word}'")).collect();
                let (last, others) = quoted.split_last().expect("two words or more");
                format!("{} or {last}", others.join(", "))
            }
        }
    }

    /// The right answer, in words.
    pub fn right(&self) -> String {
        match self {
            Self::Number(interval) => interval.to_string(),
            Self::Word { choices, right } => choices[*right].clone(),
        }
    }
}

/// Compares two answers without regard to case and spaces.
fn same(one: &str, other: &str) -> bool {
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
    plain(one) == plain(other)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use manuscript::project::Project;

    use super::super::exercise::{Exercise, Takes};
    use super::*;

    #[test]
    fn a_number_is_compared_as_a_number() {
        let answer = Answer::parse("1,580 to 1,600", None, "").unwrap();
        assert_eq!(
            ["1580", "1,600", " 1582.5 ", "1.6e3"].map(|n| answer.accept(n)),
            [Ok(true), Ok(true), Ok(true), Ok(true)]
        );
        assert_eq!(
            ["160", "1601", "-1580"].map(|n| answer.accept(n)),
            [Ok(false), Ok(false), Ok(false)]
        );
        for other in ["", "many", "1580 or 1600", "1580 to 1600", "about 1590", "NaN"] {
            assert_eq!(answer.accept(other), Err("a number".to_owned()), "{other}");
        }
    }

    #[test]
    fn a_word_is_one_of_those_that_are_listed() {
        let text = "Which mode: `random`, `naive random` or neither?";
        let answer = Answer::parse("naive random", Some("random | naive random | neither"), text);
        let answer = answer.unwrap();
        assert_eq!(
            [" Naive  Random", "random", "NEITHER"].map(|word| answer.accept(word)),
            [Ok(true), Ok(false), Ok(false)]
        );
        for other in ["", "naive", "not random", "random or naive random", "1"] {
            let form = "'random', 'naive random' or 'neither'".to_owned();
            assert_eq!(answer.accept(other), Err(form), "{other}");
        }
    }

    #[test]
    fn an_answer_that_nobody_could_give_is_refused() {
        let text = "Is it red, green, blue, black or white?";
        for (answer, choices, what) in [
            ("red", None, "'red' is not a number, and no `Choices` are listed"),
            ("red", Some("red"), "`Choices` lists 1, not two to four"),
            ("red", Some("red|green|blue|black|white"), "`Choices` lists 5, not two to four"),
            ("red", Some("red | grey"), "the question does not name the choice 'grey'"),
            ("red", Some("red |"), "the question does not name the choice ''"),
            ("red", Some("blue | green"), "`Choices` does not list the answer 'red'"),
            ("red", Some("red | blue | red"), "`Choices` lists 'red' twice"),
        ] {
            assert_eq!(Answer::parse(answer, choices, text), Err(what.to_owned()));
        }
    }

    /// Checks every question of the book: it accepts its own answer and no other.
    #[test]
    fn right_answers_pass_and_wrong_ones_fail() {
        let tool = Path::new(env!("CARGO_MANIFEST_DIR"));
        let project = Project::open(tool.ancestors().nth(2).unwrap()).unwrap();
        for exercise in Exercise::whole(&project).unwrap() {
            assert_eq!(exercise.answer.is_some(), exercise.takes == Takes::Look, "{exercise}");
            match &exercise.answer {
                Some(answer @ Answer::Word { choices, right }) => {
                    for (index, word) in choices.iter().enumerate() {
                        assert_eq!(answer.accept(word), Ok(index == *right), "{exercise}: {word}");
                    }
                }
                Some(answer @ Answer::Number(_)) => {
                    let right = answer.right();
                    let ends = right.split(" to ");
                    assert!(ends.clone().all(|end| answer.accept(end) == Ok(true)), "{exercise}");
                    let [low, high] = [ends.clone().next(), ends.last()]
                        .map(|end| end.unwrap().parse::<f64>().unwrap());
                    for wrong in [low - 1.0, high + 1.0, -low - 1.0] {
                        assert_eq!(answer.accept(&wrong.to_string()), Ok(false), "{exercise}");
                    }
                }
                None => {}
            }
        }
    }
}
