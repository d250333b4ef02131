//! The parts of the book: chapters, pages, their source files, and the differences between chapters.
//!
//! `chapters` uses it to keep the pages consistent with the code; `site` uses it to make the website.

pub mod anchor;
pub mod diff;
pub mod fault;
pub mod link;
mod moved;
pub mod page;
pub mod project;
pub mod shader;
