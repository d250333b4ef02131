//! The loop: generates and mutates inputs, and continues from those that cause a new answer.

use std::collections::HashSet;

use reference::random::Random;

use crate::fault::Found;
use crate::format::{Format, Reader};
use crate::mutation::mutate;

/// The largest number of inputs kept for mutation.
const KEPT: usize = 1000;

/// Inputs for one reader, one after the other.
pub struct Session<R> {
    name: &'static str,
    format: Format,
    reader: R,
    seed: u64,
    random: Random,
    words: Vec<&'static str>,
    /// The inputs to mutate.
    kept: Vec<Vec<u8>>,
    /// The gists of all answers so far.
    heard: HashSet<String>,
    /// Inputs to try unchanged, last first.
    waiting: Vec<Vec<u8>>,
    number: usize,
}

impl<R: Reader> Session<R> {
    /// Begins with the examples of the format and the inputs of the corpus.
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
        // Recent inputs are more likely to lead to new answers.
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
    /// The fault it caused.
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

    /// Tries this many inputs.
    ///
    /// # Errors
    /// The first fault.
    pub fn steps(&mut self, count: usize) -> Result<(), Found> {
        (0..count).try_for_each(|_| self.step())
    }

    /// The number of inputs tried, and of different answers.
    pub fn told(&self) -> (usize, usize) {
        (self.number, self.heard.len())
    }
}
