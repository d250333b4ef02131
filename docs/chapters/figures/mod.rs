//! Figures: the numbers on pages, and the measurements that gave them.
//!
//! A page's [`passage`]s have [`number`]s. Its comments bind each to a value ([`binding`]) of a [`record`], which
//! a [`measurement`] renews. `docs/chapters/README.md` tells authors how.

pub mod binding;
pub mod device_note;
pub mod figure;
pub mod measurement;
pub mod number;
pub mod passage;
pub mod record;
pub mod values;
