//! Programs that the tool runs: the built samples, Cargo, and how each ends.
//!
//! [`child`] starts every process and waits for its end; [`interrupt`] handles the signal that requests
//! termination.

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
