//! `cargo chapters prices`: what accuracy costs, the table of `docs/prices.md`, measured on this device.
//!
//! The rows stand once, in `docs/values/prices.md`: [`row`] reads them. [`timing`] runs the commands that gave their
//! stored values, with fewer frames, and [`same_price`] draws the page's picture.

pub mod command;
mod row;
mod same_price;
mod timing;
