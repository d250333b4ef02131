//! The loop: inputs are made and changed, and those that bring an answer not heard before are built upon.

use std::collections::HashSet;

use reference::random::Random;

use crate::fault::Found;
use crate::format::{Format, Reader};
use crate::mutation::mutate;

/// Inputs that are kept to build upon, at most.
const KEPT: usize = 1000;

/// Inputs for one reader, one after the other.
pub struct Session<R> {
    name: &'static str,
    format: Format,
    reader: R,
    seed: u64,
    random: Random,
    words: Vec<&'static str>,
    /// Inputs to build upon.
    kept: Vec<Vec<u8>>,
    /// The gists of the answers that were heard.
    heard: HashSet<String>,
    /// Inputs that are tried as they are, last first.
    waiting: Vec<Vec<u8>>,
    number: usize,
}

impl<R: Reader> Session<R> {
    /// Begins with the inputs of the format and of the corpus.
    pub fn new(name: &'static str, format: Format, reader: R, seed: u64) -> Self {
        let waiting = (format.seeds)();
        let words = format.grammar.map(|grammar| grammar().words().collect()).unwrap_or_default();
        let random = Random(seed);
        Self {
            name,
            format,
            reader,
            seed,
            random,
            words,
            kept: Vec::new(),
            heard: HashSet::new(),
            waiting,
            number: 0,
        }
    }

    fn input(&mut self) -> Vec<u8> {
        if let Some(seed) = self.waiting.pop() {
            return seed;
        }
        let random = &mut self.random;
        if self.kept.is_empty() || random.below(3) == 0 {
            return (self.format.make)(random);
        }
        // What was found last is likely to lead on.
        let recent = self.kept.len() - random.below(self.kept.len().min(20)) - 1;
        let any = random.below(self.kept.len());
        let base = if random.below(2) == 0 { recent } else { any };
        let other = random.below(self.kept.len());
        let (base, other) = (&self.kept[base], &self.kept[other]);
        let mut input = mutate(random, base, other, &self.words, self.format.most);
        if let Some(seal) = self.format.seal
            && random.below(8) != 0
        {
            seal(&mut input);
        }
        input
    }

    /// Tries one input.
    ///
    /// # Errors
    /// With what it brought about, if that is not allowed.
    pub fn step(&mut self) -> Result<(), Found> {
        let input = self.input();
        let number = self.number;
        self.number += 1;
        match self.reader.ask(&input) {
            Ok(answer) => {
                if self.heard.insert(answer.gist()) && self.kept.len() < KEPT {
                    self.kept.push(input);
                }
                Ok(())
            }
            Err(fault) => Err(Found { reader: self.name, seed: self.seed, number, input, fault }),
        }
    }

    /// Tries so many.
    ///
    /// # Errors
    /// With the first that is not allowed.
    pub fn steps(&mut self, count: usize) -> Result<(), Found> {
        (0..count).try_for_each(|_| self.step())
    }

    /// Number of inputs tried, and of different answers.
    pub fn told(&self) -> (usize, usize) {
        (self.number, self.heard.len())
    }
}
