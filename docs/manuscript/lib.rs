//! What the book is made of: chapters, pages, their source files, and what one chapter changes in another.
//!
//! `chapters` keeps the pages true to the code with it; `site` makes the website of it.

pub mod anchor;
pub mod diff;
pub mod fault;
pub mod link;
mod moved;
pub mod page;
pub mod project;
pub mod shader;
