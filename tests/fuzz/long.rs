//! Runs for longer than a test, or tries one input again.

use std::time::{Duration, Instant};

use fuzz::fault::{Fault, Found};
use fuzz::format::{Answer, Reader};
use fuzz::formats::FUNCTIONS;
use fuzz::program::Program;
use fuzz::session::Session;
use fuzz::watch::Watch;

use crate::{SEED, functions, programs};

/// A function or a program.
enum Either {
    Function(Session<Watch>),
    Program(Session<Program>),
}

impl Either {
    fn step(&mut self) -> Result<(), Found> {
        match self {
            Self::Function(session) => session.step(),
            Self::Program(session) => session.step(),
        }
    }

    fn told(&self) -> (usize, usize) {
        match self {
            Self::Function(session) => session.told(),
            Self::Program(session) => session.told(),
        }
    }
}

/// A number from the environment.
fn number(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text} is no whole number")))
}

/// Returns whether `FUZZ_READER` selects this reader, by a part of its name; without the variable, all are
/// selected.
fn is_wanted(name: &str) -> bool {
    std::env::var("FUZZ_READER").map_or(true, |wanted| name.contains(&wanted))
}

#[test]
#[ignore = "nightly only: an hour, or FUZZ_SECONDS; the seed is FUZZ_SEED, the readers are those that FUZZ_READER names"]
fn for_long() {
    let seconds = number("FUZZ_SECONDS").unwrap_or(3600);
    let seed = number("FUZZ_SEED").unwrap_or(SEED);
    let functions = FUNCTIONS.into_iter().filter(|one| is_wanted(one.0.name));
    let functions =
        functions.map(|one| (one.0.name, Either::Function(functions::session(one, seed))));
    let programs = programs::ALL.into_iter().chain([programs::SHADERS]);
    let programs = programs.filter(|one| is_wanted(one.name));
    let programs = programs.map(|one| (one.name, Either::Program(programs::session(one, seed))));
    let mut sessions: Vec<_> = functions.chain(programs).collect();
    assert!(!sessions.is_empty(), "no reader has such a name");
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut found = Vec::new();
    // Alternates every second, so that an interrupted run has tried all readers.
    while Instant::now() < end && !sessions.is_empty() {
        sessions.retain_mut(|(name, session)| {
            let turn = Instant::now() + Duration::from_secs(1);
            while Instant::now() < turn.min(end) {
                if let Err(fault) = session.step() {
                    let told = fault.keep();
                    println!("{told}\n");
                    found.push(told);
                    // The other readers may continue.
                    println!("{name}: no further");
                    return false;
                }
            }
            true
        });
    }
    for (name, session) in &sessions {
        let (inputs, answers) = session.told();
        println!("{name}: {inputs} inputs, {answers} answers");
    }
    assert!(found.is_empty(), "{} faults with seed {seed}:\n{}", found.len(), found.join("\n\n"));
}

#[test]
#[ignore = "by hand: shows the file FUZZ_INPUT to FUZZ_READER"]
fn one_input() {
    let [reader, file] = ["FUZZ_READER", "FUZZ_INPUT"]
        .map(|name| std::env::var(name).unwrap_or_else(|_| panic!("{name} is not set")));
    let input = std::fs::read(run::root().join(&file)).expect("the input can be read");
    match answer(&reader, &input) {
        Ok(answer) => println!("{answer:?}"),
        Err(fault) => panic!("{reader}: {fault}"),
    }
}

/// The answer of the named reader to an input.
fn answer(reader: &str, input: &[u8]) -> Result<Answer, Fault> {
    if let Some((format, function, _)) = FUNCTIONS.into_iter().find(|one| one.0.name == reader) {
        return Watch::new(format, function).ask(input);
    }
    let programs = programs::ALL.into_iter().chain([programs::SHADERS]);
    let program = programs.into_iter().find(|program| program.name == reader);
    programs::reader(program.unwrap_or_else(|| panic!("there is no reader {reader}"))).ask(input)
}
