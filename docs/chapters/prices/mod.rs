//! `cargo chapters prices`: measures the cost of accuracy on this device, for the table of `docs/prices.md`.
//!
//! The rows are listed once, in `docs/values/prices.md`, and read by [`row`]. [`timing`] runs the commands of
//! their stored values with fewer frames, and [`same_price`] draws the page's picture.

pub mod command;
pub mod row;
mod same_price;
pub mod timing;
