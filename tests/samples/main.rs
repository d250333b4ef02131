//! Every chapter, rendered headless and small, under validation: one module a chapter.

mod any_hit;
mod basic;
mod infinite_plane;
mod reflection;
#[path = "../run/mod.rs"]
mod run;
mod shadow_miss;
