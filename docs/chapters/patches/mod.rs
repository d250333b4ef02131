//! Patches to the book's code, which exercises and mistakes consist of, and the editions they make.

pub mod copy;
pub mod edition;
pub mod hunk;
pub mod patch;
mod seed;
