//! Inputs that nobody would write, for all that reads a file, a setting or a shader.
//!
//! - [`format`]: what is read: its grammar, what is tried beside it, and who reads it
//! - [`formats`]: one file each
//! - [`grammar`], [`mutation`]: where inputs come from
//! - [`session`]: the loop; inputs that bring an answer not heard before are built upon
//! - [`watch`], [`meter`]: a reader in this process, held to a time and to memory
//! - [`program`]: a whole process, held to its exit code, its one line and its folder
//! - [`fault`]: what is not allowed, and the file that brings it back
//!
//! Random numbers are seeded, and how many inputs are tried does not depend on the time: the same seed tries
//! the same inputs on every machine.

pub mod fault;
pub mod format;
pub mod formats;
pub mod grammar;
pub mod meter;
pub mod mutation;
pub mod program;
pub mod session;
pub mod watch;
