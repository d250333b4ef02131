//! Every chapter, rendered headless and small, under validation: one module a chapter.

mod basic;
#[path = "../run/mod.rs"]
mod run;
