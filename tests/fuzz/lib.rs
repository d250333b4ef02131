//! Inputs that nobody would write, for every reader of a file, a setting or a shader.
//!
//! - [`format`]: a format: its grammar, its examples and its reader
//! - [`formats`]: one per file
//! - [`grammar`], [`mutation`]: generate inputs
//! - [`session`]: the loop; inputs that cause a new answer are mutated further
//! - [`watch`], [`meter`]: a reader in this process, with limits on time and memory
//! - [`program`]: a process; checks its exit code, its message and its folder
//! - [`fault`]: the forbidden outcomes, and the file that reproduces one
//!
//! Random numbers are seeded, and the number of inputs does not depend on the time: the same seed tries the
//! same inputs on every machine.

pub mod fault;
pub mod format;
pub mod formats;
pub mod grammar;
pub mod meter;
pub mod mutation;
pub mod program;
pub mod session;
pub mod watch;
