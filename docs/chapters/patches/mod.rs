//! Patches to the book's code, and the editions of it that they make: what exercises and mistakes are.

pub mod copy;
pub mod edition;
pub mod hunk;
pub mod patch;
mod seed;
