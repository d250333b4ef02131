//! Exercises: a reader solves one in a [`workbench`], and an [`attempt`] checks it against the exercise's
//! expectations.

pub mod answer;
pub mod attempt;
pub mod code;
pub mod command;
pub mod exercise;
pub mod expectation;
pub mod fingerprint;
pub mod formula;
pub mod interval;
mod making;
pub mod mismatch;
pub mod moved;
pub mod progress;
pub mod proof;
pub mod solution;
pub mod variant;
pub mod watcher;
pub mod window;
pub mod workbench;
