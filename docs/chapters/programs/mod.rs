//! Programs that the tool runs: the samples as they are built, Cargo, and how each ends.
//!
//! [`child`] starts every process and waits for its end; [`interrupt`] is the signal that asks for ours.

pub mod change;
pub mod child;
pub mod command_line;
pub mod controls;
pub mod interrupt;
pub mod own_program;
pub mod program;
pub mod ready;
pub mod run_result;
pub mod test;
